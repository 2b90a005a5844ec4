//! Pictures as PDF, with the cargo feature `formats`.

use super::answer::Failure;

/// A picture as PDF. Its text is set in DejaVu Sans if this machine has it, else in any font.
///
/// # Errors
/// A failure without any font, or without the cargo feature.
#[cfg(feature = "formats")]
pub(super) fn pdf(svg: &str) -> Result<Vec<u8>, Failure> {
    use svg2pdf::usvg::{Options, Tree, fontdb::Database};
    const WANTED: &str = "DejaVu Sans";

    let mut options = Options::default();
    let fonts: &mut Database = options.fontdb_mut();
    fonts.load_system_fonts();
    let families = |fonts: &Database| -> Vec<String> {
        let faces = fonts.faces().filter_map(|face| face.families.first());
        faces.map(|(name, _)| name.clone()).collect()
    };
    let families = families(fonts);
    let wanted = families.iter().find(|name| *name == WANTED);
    let Some(family) = wanted.or(families.first()) else {
        let why = "a PDF needs a font, and this machine has none: install one, for example DejaVu Sans (fonts-dejavu-core)";
        return Err(Failure::failed(why));
    };
    fonts.set_sans_serif_family(family);
    let failed = |error: String| Failure::failed(format!("drawing the PDF: {error}"));
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(error.to_string()))?;
    svg2pdf::to_pdf(&tree, Default::default(), Default::default())
        .map_err(|error| failed(error.to_string()))
}

/// Says that this build makes no PDF.
///
/// # Errors
/// Always: the command asks for what this build has not.
#[cfg(not(feature = "formats"))]
pub(super) fn pdf(_: &str) -> Result<Vec<u8>, Failure> {
    let why = "this program was built without PDF: build it with `--features formats`, or leave out `--pdf`";
    Err(Failure::usage(why))
}

//! The checked-in header is the one that cbindgen makes from this crate. `MPP_HEADER=save` writes it.

use std::path::Path;

#[test]
fn the_header_is_made_from_the_code() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut config =
        cbindgen::Config::from_file(folder.join("../cbindgen.toml")).expect("it is read");
    config.after_includes = Some(format!(
        "\n#define MPP_VERSION \"{}\"",
        env!("CARGO_PKG_VERSION")
    ));
    let mut made = Vec::new();
    cbindgen::Builder::new()
        .with_config(config)
        .with_src(folder.join("src/lib.rs"))
        .with_src(folder.join("../../../mpp-data/src/airframe.rs"))
        .generate()
        .expect("a header is made")
        .write(&mut made);
    let path = folder.join("../include/mpp.h");
    // Rustdoc takes a unit in plain brackets for a link.
    let made = String::from_utf8(made).expect("it is text");
    let made = made.replace(r"\[", "[").replace(r"\]", "]");
    if std::env::var_os("MPP_HEADER").is_some_and(|wish| wish == "save") {
        std::fs::write(&path, &made).expect("it is written");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == made,
        "{} is not what the code says: run `MPP_HEADER=save cargo test -p mpp-c header::`",
        path.display()
    );
}

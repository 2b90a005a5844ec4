//! What a release says of itself: the packages inside with their licences, a bill of materials, and checksums.

use crate::folders::{VERSION, files};
use crate::toolchain::{cargo, output};
use anyhow::{Context, Result};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

pub(super) fn write(place: &Path) -> Result<()> {
    let packages = packages()?;
    let parts: Vec<Value> = packages.iter().map(component).collect();
    let bill = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "name": "mpp", "version": VERSION}},
        "components": parts,
    });
    let bill = serde_json::to_string_pretty(&bill)?;
    fs::write(place.join(format!("mpp-{VERSION}.cdx.json")), bill)?;
    fs::write(place.join("LICENCES.txt"), licences(&packages)?)?;
    let mut sums = Command::new("sha256sum");
    sums.current_dir(place);
    for file in files(place)? {
        sums.arg(file.file_name().context("a file has a name")?);
    }
    let sums = output(&mut sums)?;
    Ok(fs::write(place.join("SHA256SUMS"), sums)?)
}

/// What cargo knows of each package that the harness and the libraries hold.
fn packages() -> Result<Vec<Value>> {
    let tree = output(&mut cargo(
        "tree --locked --workspace --prefix none --edges normal,build --format {p} \
         --features sil-harness/formats,sil-harness/clarabel",
    ))?;
    let held: BTreeSet<(&str, &str)> = tree
        .lines()
        .filter_map(|line| {
            let mut words = line.split(' ');
            Some((words.next()?, words.next()?.strip_prefix('v')?))
        })
        .collect();
    let metadata = output(&mut cargo(
        "metadata --locked --format-version 1 --all-features",
    ))?;
    let metadata: Value = serde_json::from_str(&metadata)?;
    let all = metadata["packages"].as_array().context("no packages")?;
    Ok(all
        .iter()
        .filter(|it| held.contains(&(text(it, "name"), text(it, "version"))))
        .cloned()
        .collect())
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_default()
}

fn component(package: &Value) -> Value {
    let [name, version, licence] = ["name", "version", "license"].map(|key| text(package, key));
    json!({
        "type": "library",
        "name": name,
        "version": version,
        "purl": format!("pkg:cargo/{name}@{version}"),
        "licenses": [{"expression": licence.replace('/', " OR ")}],
    })
}

/// The licence of each package, and the texts in its folder.
fn licences(packages: &[Value]) -> Result<String> {
    let mut told = String::new();
    let mut texts = BTreeSet::new();
    for package in packages {
        let [name, version, licence] = ["name", "version", "license"].map(|key| text(package, key));
        told += &format!("{name} {version}: {licence}\n");
        let folder = Path::new(text(package, "manifest_path")).parent();
        for file in files(folder.context("a manifest has a folder")?)? {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            let is_licence = ["LICEN", "COPYING", "NOTICE", "UNLICENSE"];
            if file.is_file()
                && is_licence
                    .iter()
                    .any(|it| name.to_uppercase().starts_with(it))
            {
                texts.insert(fs::read_to_string(&file)?.trim().to_owned());
            }
        }
    }
    for text in texts {
        told += &format!("\n{:-<80}\n\n{text}\n", "");
    }
    Ok(told)
}

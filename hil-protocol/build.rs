//! Makes the MAVLink messages from `dialect/*.xml`.

use mavlink_bindgen::{XmlDefinitions, generate};
use std::env;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=dialect");
    // What generated code asks for: its own dialect, on; the rest, never.
    println!("cargo::rustc-cfg=feature=\"dialect-mpp\"");
    println!(
        "cargo::rustc-check-cfg=cfg(feature, values(\"dialect-mpp\", \"serde\", \"arbitrary\", \
         \"ts-rs\", \"std\"))"
    );
    generate(
        XmlDefinitions::Files(vec!["dialect/mpp.xml"]),
        env::var("OUT_DIR")?,
    )?;
    Ok(())
}

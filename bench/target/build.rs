//! Turns exported programs (`bench qp --export`, named by `PROGRAMS`) into constants of the image.

use serde_json::Value;
use std::error::Error;
use std::fmt::Write;

/// All numbers of a list of lists, in order.
fn flatten(value: &Value, out: &mut Vec<f64>) {
    match value {
        Value::Array(list) => list.iter().for_each(|value| flatten(value, out)),
        value => out.push(value.as_f64().unwrap_or(f64::INFINITY)),
    }
}

/// A field's `count` numbers, `absent` if there is no such field.
fn numbers(program: &Value, field: &str, count: usize, absent: f64) -> String {
    let mut found = Vec::new();
    match &program[field] {
        Value::Null => found.resize(count, absent),
        value => flatten(value, &mut found),
    }
    assert_eq!(found.len(), count, "{field}");
    let words = found.iter().map(|value| match value.is_finite() {
        true => format!("{value:?}"),
        false => format!("{}INFINITY", if *value < 0.0 { "-" } else { "" }),
    });
    words.collect::<Vec<_>>().join(", ")
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed=PROGRAMS");
    println!("cargo:rerun-if-changed=link.x");
    let file = std::env::var("PROGRAMS")?;
    println!("cargo:rerun-if-changed={file}");
    println!("cargo:rustc-link-arg=-T{}/link.x", std::env::var("CARGO_MANIFEST_DIR")?);
    let text = std::fs::read_to_string(file)?;
    let mut source = "static PROGRAMS: &[Program] = &[\n".to_owned();
    for line in text.lines().filter(|line| !line.trim().is_empty()) {
        let program = serde_json::from_str(line)?;
        source += "Program {";
        for (field, count, absent) in [
            ("a", 36, 0.0),
            ("b", 12, 0.0),
            ("control_weight", 2, 0.0),
            ("terminal_weight", 1, 0.0),
            ("initial", 6, 0.0),
            ("target", 6, 0.0),
            ("position_bounds", 152, f64::INFINITY),
            ("thrust_reserve", 1, f64::INFINITY),
            ("attitude", 4, f64::INFINITY),
            ("penalty", 2, 0.0),
        ] {
            write!(source, "{field}: [{}],", numbers(&program, field, count, absent))?;
        }
        source += "},\n";
    }
    source += "];\n";
    std::fs::write(format!("{}/programs.rs", std::env::var("OUT_DIR")?), source)?;
    Ok(())
}

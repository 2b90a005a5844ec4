//! Turns exported programs (`bench qp --export`, named by `PROGRAMS`) into constants of the image.

use serde_json::Value;
use std::error::Error;

/// Fields of a program and how many numbers each holds, in the order in which the image reads them.
const FIELDS: [(&str, usize); 11] = [
    ("a", 36),
    ("b", 12),
    ("control_weight", 2),
    ("terminal_weight", 1),
    ("initial", 6),
    ("target", 6),
    ("position_bounds", 152),
    ("thrust_rise", 1),
    ("thrust_reserve", 1),
    ("attitude", 4),
    ("penalty", 2),
];

/// All numbers of a list of lists, in order; what is no number was infinite.
fn flatten(value: &Value, out: &mut Vec<f64>) {
    match value {
        Value::Array(list) => list.iter().for_each(|value| flatten(value, out)),
        value => out.push(value.as_f64().unwrap_or(f64::INFINITY)),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let (file, home) = (
        std::env::var("PROGRAMS")?,
        std::env::var("CARGO_MANIFEST_DIR")?,
    );
    println!("cargo:rerun-if-env-changed=PROGRAMS\ncargo:rerun-if-changed={file}");
    println!("cargo:rerun-if-changed=link.x\ncargo:rustc-link-arg=-T{home}/link.x");
    let count: usize = FIELDS.iter().map(|(_, count)| count).sum();
    let mut source = format!("static PROGRAMS: &[[Real; {count}]] = &[");
    for line in std::fs::read_to_string(file)?.lines() {
        let (program, mut numbers) = (serde_json::from_str::<Value>(line)?, Vec::new());
        // The image has no field for it.
        let hard = program["hard_angle_of_attack"].to_string();
        assert!(!hard.contains("true"), "hard_angle_of_attack is {hard}");
        let mut end = 0;
        for (field, count) in FIELDS {
            end += count;
            match &program[field] {
                Value::Null => numbers.resize(end, f64::INFINITY),
                value => flatten(value, &mut numbers),
            }
            assert_eq!(numbers.len(), end, "{field}");
        }
        source += &format!("{numbers:?},\n").replace("inf", "INFINITY");
    }
    std::fs::write(
        format!("{}/programs.rs", std::env::var("OUT_DIR")?),
        source + "];",
    )?;
    Ok(())
}

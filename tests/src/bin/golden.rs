//! Flies the golden flights. Prints the table, or with `--save` writes it in place of the expected
//! table.

use mpp_tests::golden::{Failure, table, table_path};

fn main() -> Result<(), Failure> {
    let save = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--save") => true,
        Some(other) => {
            return Err(format!("unknown argument {other}: give --save or nothing").into());
        }
    };
    let table = table()?;
    print!("{table}");
    if save {
        std::fs::write(table_path(), &table)?;
    }
    Ok(())
}

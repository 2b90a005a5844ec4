//! `wasm`: builds the simulation for browsers.

use crate::toolchain::{Toolchain, succeed};
use anyhow::Result;

/// Builds the simulation for WebAssembly.
pub(crate) fn build() -> Result<()> {
    let toolchain = Toolchain::find("wasm32-unknown-unknown")?;
    succeed(
        toolchain
            .cargo("build", "")?
            .args(["--locked", "-p", "mpp-sim"]),
    )?;
    println!("mpp-sim builds for wasm32-unknown-unknown");
    Ok(())
}

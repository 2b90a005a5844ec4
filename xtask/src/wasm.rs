//! `wasm` and `web`: builds the simulation for browsers, and the page that flies it.

use crate::folders::{root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TARGET: &str = "wasm32-unknown-unknown";
/// Greatest size of the page as a server would send it \[bytes\].
const PAGE_MAX: usize = 500_000;
/// The crates in which a flight in the browser spends most of its time. They are built for speed, and the rest for size.
const FAST: [&str; 5] = ["mpp-data", "mpp-core", "hil-protocol", "libm", "nalgebra"];
/// The parts of the page, in order. The module comes after the last one.
const PARTS: [&str; 10] = [
    "mpp-analysis/src/picture/page_head.html",
    "mpp-analysis/src/picture/page.css",
    "bindings/web/page/body.html",
    "mpp-analysis/src/picture/draw.js",
    "mpp-analysis/src/picture/charts.js",
    "mpp-analysis/src/picture/numbers.js",
    "bindings/web/page/duel.js",
    "bindings/web/page/point.js",
    "bindings/web/page/link.js",
    "bindings/web/page/fly.js",
];

/// Builds the simulation and its interface for WebAssembly, with flights in space or as the page has it. Returns the path of the
/// module.
pub(crate) fn build(in_space: bool) -> Result<PathBuf> {
    let toolchain = Toolchain::find(TARGET)?;
    let mut cargo = toolchain.cargo("rustc", "")?;
    cargo.args(["--config", "profile.release.opt-level='s'"]);
    for package in FAST {
        let level = format!("profile.release.package.{package}.opt-level=3");
        cargo.args(["--config", &level]);
    }
    if in_space {
        cargo.args(["--features", "space"]);
    }
    cargo
        .args(["--locked", "--release", "-p", "mpp-web", "--lib"])
        .args(["--crate-type", "cdylib", "--", "-C", "strip=symbols"]);
    if in_space {
        // The core in space is built on the stack before it moves to its box.
        cargo.args(["-C", "link-arg=-zstack-size=33554432"]);
    }
    succeed(&mut cargo)?;
    Ok(work("")?.join(TARGET).join("release/mpp_web.wasm"))
}

/// Builds the page. It holds all that it needs. Returns its file.
pub(crate) fn page() -> Result<PathBuf> {
    let module = gzip(&std::fs::read(build(false)?)?)?;
    let mut page = String::new();
    for part in PARTS {
        page += &std::fs::read_to_string(root().join(part)).context(part)?;
    }
    page += &format!(
        "start(\"{}\");\n</script>\n</html>\n",
        BASE64_STANDARD.encode(&module)
    );
    let path = work("web")?.join("fly.html");
    std::fs::write(&path, &page)?;
    let sent = gzip(page.as_bytes())?.len();
    println!(
        "{}: {} kB, {} kB gzipped, of which the module {} kB",
        path.display(),
        page.len() / 1000,
        sent / 1000,
        module.len() / 1000
    );
    ensure!(
        sent < PAGE_MAX,
        "the page is larger than {PAGE_MAX} bytes as it is sent: make it smaller"
    );
    Ok(path)
}

/// Flies scenarios in Node, one a line as JSON. Returns the hash of each log.
pub(crate) fn fly(module: &Path, scenarios: &[String]) -> Result<Vec<String>> {
    if Command::new("node").arg("--version").output().is_err() {
        install(&[("/usr/bin/node", "nodejs")])?;
    }
    let mut node = Command::new("node");
    node.arg(root().join("bindings/web/fly.mjs"))
        .arg(module)
        .args(scenarios);
    let text = output(&mut node).context("flying in Node")?;
    Ok(text.lines().map(str::to_owned).collect())
}

/// The bytes through `gzip`, the same for the same bytes.
fn gzip(bytes: &[u8]) -> Result<Vec<u8>> {
    use std::io::Write;
    let mut gzip = Command::new("gzip")
        .args(["-9", "-n"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .context("running gzip")?;
    let mut input = gzip.stdin.take().context("no input")?;
    let all = bytes.to_vec();
    let writer = std::thread::spawn(move || input.write_all(&all));
    let packed = gzip.wait_with_output()?;
    writer
        .join()
        .map_err(|_| anyhow::anyhow!("gzip reads nothing"))??;
    ensure!(packed.status.success(), "gzip failed: {}", packed.status);
    Ok(packed.stdout)
}

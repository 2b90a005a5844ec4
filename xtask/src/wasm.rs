//! `wasm` and `web`: builds the simulation for browsers, and the pages that fly it.

use crate::folders::{root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TARGET: &str = "wasm32-unknown-unknown";
/// The crates in which a flight in the browser spends most of its time. They are built for speed, and the rest for size.
const FAST: [&str; 5] = ["mpp-data", "mpp-core", "hil-protocol", "libm", "nalgebra"];
/// What every page begins with, and asks its module with.
const FIRST: [&str; 2] = [
    "mpp-analysis/src/picture/page_head.html",
    "mpp-analysis/src/picture/page.css",
];
/// The pages.
const PAGES: [Page; 2] = [
    Page {
        name: "fly.html",
        in_space: false,
        most: 500_000,
        parts: &[
            "bindings/web/page/body.html",
            "mpp-analysis/src/picture/draw.js",
            "mpp-analysis/src/picture/plane.js",
            "mpp-analysis/src/picture/charts.js",
            "mpp-analysis/src/picture/numbers.js",
            "bindings/web/page/ask.js",
            "bindings/web/page/duel.js",
            "bindings/web/page/point.js",
            "bindings/web/page/link.js",
            "bindings/web/page/fly.js",
        ],
    },
    Page {
        name: "forest.html",
        in_space: true,
        most: 900_000,
        parts: &[
            "mpp-analysis/src/picture/space/space.css",
            "bindings/web/page/forest/body.html",
            "mpp-analysis/src/picture/draw.js",
            "bindings/web/page/ask.js",
            "bindings/web/page/link.js",
            "bindings/web/page/forest/worker.js",
            "mpp-analysis/src/picture/space/flight.js",
            "mpp-analysis/src/picture/space/camera.js",
            "mpp-analysis/src/picture/space/scene.js",
            "mpp-analysis/src/picture/space/maps.js",
            "bindings/web/page/forest/forest.js",
        ],
    },
];

/// A page that holds all that it needs.
struct Page {
    name: &'static str,
    /// Whether its module flies in space.
    in_space: bool,
    /// Greatest size as a server would send it \[bytes\].
    most: usize,
    /// Its parts, in order. The module comes after the last one.
    parts: &'static [&'static str],
}

/// Builds the simulation and its interface for WebAssembly, with flights in space or in the vertical plane. Returns the path of the
/// module.
pub(crate) fn build(in_space: bool) -> Result<PathBuf> {
    let toolchain = Toolchain::find(TARGET)?;
    let mut cargo = toolchain.cargo("rustc", "")?;
    cargo.args(["--config", "profile.release.opt-level='s'"]);
    for package in FAST {
        let level = format!("profile.release.package.{package}.opt-level=3");
        cargo.args(["--config", &level]);
    }
    let module = if in_space { "space" } else { "plane" };
    cargo
        .args(["--locked", "--release", "-p", "mpp-web", "--example"])
        .args([module, "--", "-C", "strip=symbols"]);
    if in_space {
        // The core in space is built on the stack before it moves to its box.
        cargo.args(["-C", "link-arg=-zstack-size=33554432"]);
    }
    succeed(&mut cargo)?;
    let built = work("")?.join(TARGET).join("release/examples");
    Ok(built.join(format!("{module}.wasm")))
}

/// Builds the pages. Returns their files.
pub(crate) fn pages() -> Result<Vec<PathBuf>> {
    PAGES.iter().map(page).collect()
}

fn page(made: &Page) -> Result<PathBuf> {
    println!("{}: building its module ..", made.name);
    let module = gzip(&std::fs::read(build(made.in_space)?)?)?;
    let mut page = String::new();
    for part in FIRST.iter().chain(made.parts) {
        page += &std::fs::read_to_string(root().join(part)).context(*part)?;
    }
    page += &format!(
        "start(\"{}\");\n</script>\n</html>\n",
        BASE64_STANDARD.encode(&module)
    );
    let path = work("web")?.join(made.name);
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
        sent < made.most,
        "the page is larger than {} bytes as it is sent: make it smaller",
        made.most
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

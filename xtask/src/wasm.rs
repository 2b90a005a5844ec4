//! `wasm` and `web`: builds the simulation for browsers, and the page that flies it.

use crate::folders::{root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const TARGET: &str = "wasm32-unknown-unknown";
/// Greatest size of the page as a server would send it \[bytes\].
const PAGE_MAX: usize = 500_000;
/// The crates in which a flight in the browser spends its time. They are built for speed, and the rest for size.
const FAST: [&str; 6] = [
    "mpp-data",
    "mpp-core",
    "mpp-sim",
    "hil-protocol",
    "libm",
    "nalgebra",
];
/// The parts of the page, in order. The module comes after the last one.
const PARTS: [&str; 7] = [
    "mpp-analysis/src/picture/page_head.html",
    "mpp-analysis/src/picture/page.css",
    "bindings/web/page/body.html",
    "mpp-analysis/src/picture/draw.js",
    "mpp-analysis/src/picture/charts.js",
    "mpp-analysis/src/picture/numbers.js",
    "bindings/web/page/fly.js",
];

/// Builds the simulation and its interface for WebAssembly. Returns the path of the module.
pub(crate) fn build() -> Result<PathBuf> {
    let toolchain = Toolchain::find(TARGET)?;
    let mut cargo = toolchain.cargo("rustc", "")?;
    cargo.args(["--config", "profile.release.opt-level='s'"]);
    for package in FAST {
        let level = format!("profile.release.package.{package}.opt-level=3");
        cargo.args(["--config", &level]);
    }
    succeed(
        cargo
            .args(["--locked", "--release", "-p", "mpp-web", "--lib"])
            .args(["--crate-type", "cdylib", "--", "-C", "strip=symbols"]),
    )?;
    Ok(work("")?.join(TARGET).join("release/mpp_web.wasm"))
}

/// Builds the page. It holds all that it needs.
pub(crate) fn page() -> Result<()> {
    let module = gzip(&std::fs::read(build()?)?)?;
    let mut page = String::new();
    for part in PARTS {
        page += &std::fs::read_to_string(root().join(part)).context(part)?;
    }
    page += &format!("start(\"{}\");\n</script>\n</html>\n", base64(&module));
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
    Ok(())
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

/// Bytes as text of 64 letters (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |index: usize| u32::from(three.get(index).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for place in 0..4 {
            if place <= three.len() {
                let letter = bits >> (18 - 6 * place) & 63;
                text.push(char::from(LETTERS[letter as usize]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    /// The examples of RFC 4648, section 10.
    #[test]
    fn bytes_are_written_as_the_standard_says() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}

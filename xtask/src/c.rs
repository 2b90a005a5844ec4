//! `c`: the core's C interface. Flies the example under sanitizers, and links the library for a Cortex-M7.

use crate::flight::Harness;
use crate::folders::{root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use std::process::Command;

const THUMB: &str = "thumbv7em-none-eabihf";
/// Everything that the library exports. The link begins here.
const EXPORTS: [&str; 10] = [
    "mpp_text",
    "mpp_storage_size",
    "mpp_init",
    "mpp_usual",
    "mpp_set_up",
    "mpp_step",
    "mpp_begin",
    "mpp_advance",
    "mpp_finish",
    "mpp_counters",
];

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct CArgs {
    /// Number of seeds that the example flies
    #[arg(long, default_value_t = 3)]
    flights: u64,
}

pub(crate) fn run(args: &CArgs) -> Result<()> {
    example(args.flights)?;
    library()
}

/// Flies the example under the sanitizers of addresses and undefined behaviour, and compares its hashes with the
/// harness's.
fn example(flights: u64) -> Result<()> {
    let folder = work("c")?;
    let host = Harness::build(&folder)?;
    let mut cargo = Command::new("cargo");
    cargo.current_dir(root());
    succeed(cargo.args(["build", "--quiet", "--locked", "-p", "mpp-c-plant"]))?;
    // The harness stands in the folder beside.
    let built = host
        .program()
        .ancestors()
        .nth(2)
        .context("no target folder")?;
    install(&[("/usr/bin/cc", "gcc")])?;
    let program = folder.join("fly");
    let mut cc = Command::new("cc");
    cc.current_dir(root().join("bindings/c"))
        .args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-O1", "-g"])
        .args(["-fsanitize=address,undefined", "-fno-sanitize-recover=all"])
        .args(["-I", "include", "example/fly.c"])
        .arg(built.join("debug/libmpp_c_plant.a"))
        .args(["-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program);
    succeed(&mut cc)?;
    for seed in 1..=flights {
        let said = output(Command::new(&program).arg(seed.to_string()))?;
        let own = host.fly(&["--seed".to_owned(), seed.to_string()])?;
        print!("{said}");
        ensure!(
            said.contains(own.hash()),
            "the harness has {}: the flights differ",
            own.hash()
        );
    }
    Ok(())
}

/// Links all exports of the library for a Cortex-M7. This fails if one of them can panic.
fn library() -> Result<()> {
    let embed = "bindings/c/embed";
    // The workspace's versions are used. This is not --locked: cargo drops the packages that are not used here.
    std::fs::copy(
        root().join("Cargo.lock"),
        root().join(embed).join("Cargo.lock"),
    )?;
    let toolchain = Toolchain::find(THUMB)?;
    let mut cargo = toolchain.cargo("build", embed)?;
    cargo.env(
        "CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS",
        "-Ctarget-cpu=cortex-m7",
    );
    succeed(cargo.arg("--release"))?;
    let library = work("")?.join(THUMB).join("release/libmpp_c_embed.a");
    install(&[("/usr/bin/ld.lld", "lld")])?;
    let linked = work("c")?.join("gate.elf");
    let mut link = Command::new("ld.lld");
    link.args(["-m", "armelf", "--gc-sections", "--entry=mpp_init", "-o"])
        .arg(&linked);
    link.args(EXPORTS.map(|name| format!("--undefined={name}")));
    succeed(link.arg(&library)).context("the library can panic, or lacks an export")?;
    println!("{} links without a panic", library.display());
    Ok(())
}

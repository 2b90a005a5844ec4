//! The C library as people install it: archives, header, pkg-config and CMake, for hosts and flight computers.

use crate::deb;
use crate::folders::{VERSION, root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use std::fs::{copy, create_dir_all, write};
use std::path::{Path, PathBuf};
use std::process::Command;

const EMBED: &str = "bindings/c/embed";
const THUMB: &str = "thumbv7em-none-eabihf";

/// Builds the library for a Cortex-M: `cortex-m7`, or `cortex-m4` whose processor has single floats alone.
pub(crate) fn cortex_m(processor: &str) -> Result<PathBuf> {
    let toolchain = Toolchain::find(THUMB)?;
    let mut cargo = toolchain.cargo("build", lock()?)?;
    let flags = format!("-Ctarget-cpu={processor}");
    cargo.env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS", flags);
    succeed(cargo.arg("--release"))?;
    let kept = work("c")?.join(format!("libmpp-{processor}.a"));
    copy(work("")?.join(THUMB).join("release/libmpp.a"), &kept)?;
    Ok(kept)
}

/// Builds the library for this machine: the folder with `libmpp.a` and `libmpp.so`.
fn host() -> Result<PathBuf> {
    let target = work("c/host")?;
    let mut cargo = Command::new("cargo");
    cargo
        .current_dir(root().join(lock()?))
        .args(["build", "--quiet", "--release", "--target-dir"]);
    succeed(cargo.arg(&target))?;
    Ok(target.join("release"))
}

/// Gives the library's workspace the versions of ours. It is not built `--locked`: cargo drops what is not used there.
fn lock() -> Result<&'static str> {
    copy(
        root().join("Cargo.lock"),
        root().join(EMBED).join("Cargo.lock"),
    )?;
    Ok(EMBED)
}

/// Lays the library out below `prefix`, for this machine. `plant` is the archive of core and simulated aircraft.
pub(crate) fn lay_out(prefix: &Path, plant: &Path) -> Result<()> {
    let built = host()?;
    let [include, libraries] = ["include", "lib"].map(|name| prefix.join(name));
    let [pkgconfig, cmake] = ["pkgconfig", "cmake/mpp"].map(|name| libraries.join(name));
    for folder in [&include, &pkgconfig, &cmake] {
        create_dir_all(folder)?;
    }
    let from = root().join("bindings/c");
    for header in ["mpp.h", "mpp_plant.h"] {
        copy(from.join("include").join(header), include.join(header))?;
    }
    for library in ["libmpp.a", "libmpp.so"] {
        copy(built.join(library), libraries.join(library))?;
    }
    copy(plant, libraries.join("libmpp_plant.a"))?;
    check_names(&libraries.join("libmpp.so"))?;
    write(pkgconfig.join("mpp.pc"), pkg_config())?;
    copy(
        from.join("mpp-config.cmake"),
        cmake.join("mpp-config.cmake"),
    )?;
    write(cmake.join("mpp-config-version.cmake"), cmake_version())?;
    manifests(prefix)
}

/// Makes the folder a Zephyr module and a PlatformIO library, too: both take the archives for Cortex-M.
fn manifests(prefix: &Path) -> Result<()> {
    let from = root().join("bindings/c");
    deb::copy_folder(&from.join("zephyr"), &prefix.join("zephyr"))?;
    let platformio = from.join("platformio");
    copy(platformio.join("link.py"), prefix.join("link.py"))?;
    let library = std::fs::read_to_string(platformio.join("library.json"))?;
    write(
        prefix.join("library.json"),
        library.replace("VERSION", VERSION),
    )?;
    Ok(())
}

/// Whether the Zephyr module finds header and archive of each processor. Zephyr itself is not here: its functions are stand-ins.
pub(super) fn try_zephyr(prefix: &Path, folder: &Path) -> Result<()> {
    let script = folder.join("zephyr.cmake");
    write(
        &script,
        format!(
            "function(must_exist path)\n  if(NOT EXISTS ${{path}})\n    message(FATAL_ERROR \"no ${{path}}\")\n  endif()\nendfunction()\n\
             function(zephyr_include_directories path)\n  must_exist(${{path}}/mpp.h)\nendfunction()\n\
             function(zephyr_library_import name path)\n  must_exist(${{path}})\n  message(\"${{path}}\")\nendfunction()\n\
             include({}/zephyr/CMakeLists.txt)\n",
            prefix.display()
        ),
    )?;
    for (double, processor) in [("y", "cortex-m7"), ("n", "cortex-m4")] {
        let mut cmake = Command::new("cmake");
        cmake.arg("-DCONFIG_MPP=y");
        cmake.arg(format!("-DCONFIG_CPU_HAS_FPU_DOUBLE_PRECISION={double}"));
        let said = cmake.arg("-P").arg(&script).output()?;
        let said = String::from_utf8_lossy(&said.stderr).into_owned();
        let linked = format!("lib/{processor}/libmpp.a");
        ensure!(said.trim().ends_with(&linked), "the Zephyr module: {said}");
    }
    Ok(())
}

/// What the library exports begins with `mpp_`.
fn check_names(library: &Path) -> Result<()> {
    let mut nm = Command::new("nm");
    let names = output(nm.args(["-D", "--defined-only"]).arg(library))?;
    let foreign = names.lines().find(|line| !line.contains(" T mpp_"));
    ensure!(foreign.is_none(), "libmpp.so exports {foreign:?}");
    Ok(())
}

fn pkg_config() -> String {
    format!(
        "prefix=${{pcfiledir}}/../..\n\nName: mpp\nDescription: The MPP flight core\nVersion: {VERSION}\n\
         Cflags: -I${{prefix}}/include\nLibs: -L${{prefix}}/lib -lmpp\nLibs.private: -lm -lpthread -ldl\n"
    )
}

/// Versions fit if the second number is the same, as the first is 0.
fn cmake_version() -> String {
    let (minor, _) = VERSION.rsplit_once('.').unwrap_or((VERSION, ""));
    format!(
        "set(PACKAGE_VERSION {VERSION})\nif(PACKAGE_FIND_VERSION VERSION_LESS_EQUAL {VERSION}\n   \
         AND PACKAGE_FIND_VERSION VERSION_GREATER_EQUAL {minor})\n  set(PACKAGE_VERSION_COMPATIBLE TRUE)\n\
         endif()\nif(PACKAGE_FIND_VERSION VERSION_EQUAL {VERSION})\n  set(PACKAGE_VERSION_EXACT TRUE)\nendif()\n"
    )
}

/// Builds the example as a user does, by CMake and by one line with pkg-config. Returns the program of the first.
pub(crate) fn try_out(prefix: &Path, folder: &Path) -> Result<PathBuf> {
    install(&[
        ("/usr/bin/cmake", "cmake"),
        ("/usr/bin/make", "make"),
        ("/usr/bin/pkg-config", "pkg-config"),
    ])?;
    let example = root().join("bindings/c/example");
    let built = folder.join("cmake");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(&example).arg("-B").arg(&built);
    configure.arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display()));
    output(configure.arg("-DCMAKE_BUILD_TYPE=Release"))?;
    output(Command::new("cmake").arg("--build").arg(&built))?;
    let source = folder.join("version.c");
    write(
        &source,
        "#include <mpp.h>\n#include <stdio.h>\n#include <string.h>\n\
         int main(void) { puts(mpp_version()); return strcmp(mpp_version(), MPP_VERSION); }\n",
    )?;
    for how in ["--static", "--shared"] {
        let mut shell = Command::new("sh");
        let libraries = prefix.join("lib");
        let place = libraries.display();
        let line = match how {
            "--static" => {
                format!("cc version.c -o version -I{place}/../include {place}/libmpp.a -lm")
            }
            _ => format!(
                "cc version.c -o version $(PKG_CONFIG_PATH={place}/pkgconfig pkg-config --cflags --libs mpp) -Wl,-rpath,{place}"
            ),
        };
        let said = output(
            shell
                .current_dir(folder)
                .arg("-c")
                .arg(format!("{line} && ./version")),
        )?;
        ensure!(said.trim() == VERSION, "the library says {said}");
    }
    let program = built.join("fly");
    program
        .is_file()
        .then_some(program)
        .context("CMake built no program")
}

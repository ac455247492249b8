//! Asks the linker to place alike functions side by side, so that a wheel packs them smaller. LLD, with which
//! rustc links for x86-64 Linux, can; a linker that cannot is left alone.

use std::env::{self, VarError};
use std::path::Path;
use std::process::{Command, Stdio};

/// Orders sections for compression, and folds functions of equal instructions.
const FLAGS: [&str; 2] = ["-Wl,--bp-compression-sort=both", "-Wl,--icf=all"];

fn main() -> Result<(), VarError> {
    println!("cargo::rerun-if-changed=build.rs");
    // Linkers of other systems take such flags with another meaning, or ignore them with a warning.
    if env::var("CARGO_CFG_TARGET_OS")? == "linux" {
        for flag in FLAGS {
            if links_with(flag)? {
                println!("cargo::rustc-link-arg-cdylib={flag}");
            }
        }
    }
    Ok(())
}

/// Whether an empty library is linked with the flag, by the compiler and the linker that link the module.
fn links_with(flag: &str) -> Result<bool, VarError> {
    let folder = env::var("OUT_DIR")?;
    let source = Path::new(&folder).join("empty.rs");
    let mut compiler = Command::new(env::var("RUSTC")?);
    compiler
        .args(["--crate-type", "cdylib", "--target", &env::var("TARGET")?])
        .args(["--out-dir", &folder])
        .arg(format!("-Clink-arg={flag}"))
        .arg(&source);
    if let Ok(linker) = env::var("RUSTC_LINKER") {
        compiler.arg(format!("-Clinker={linker}"));
    }
    if let Ok(flags) = env::var("CARGO_ENCODED_RUSTFLAGS") {
        compiler.args(flags.split('\x1f').filter(|flag| !flag.is_empty()));
    }
    let quiet = compiler.stdout(Stdio::null()).stderr(Stdio::null());
    let linked = std::fs::write(&source, "").and_then(|()| quiet.status());
    Ok(linked.is_ok_and(|status| status.success()))
}

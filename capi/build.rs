//! Names the shared library for the ABI it keeps: `libricci.so.0.<minor>` until 1.0, then `libricci.so.<major>`.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let version = |part: &str| std::env::var(format!("CARGO_PKG_VERSION_{part}")).unwrap_or_default();
    let abi = match version("MAJOR") {
        major if major == "0" => format!("0.{}", version("MINOR")),
        major => major,
    };
    match std::env::var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("linux" | "freebsd" | "netbsd" | "openbsd" | "android") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libricci.so.{abi}");
        }
        Ok("macos") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libricci.{abi}.dylib");
        }
        _ => {}
    }
}

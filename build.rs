//! Looks for MUMPS and MPI of the system under the feature `mumps`; without it, does nothing.
//!
//! `MPICC` names the compiler wrapper of MPI (`mpicc`), `MUMPS_DIR` a folder with `include` and `lib` where MUMPS
//! does not stand where the system looks, `MUMPS_LIBS` its libraries (`dmumps mumps_common`). Where there is no
//! MUMPS the crate is built without it, with a warning, and says so when the engine is asked for.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(mumps)");
    #[cfg(feature = "mumps")]
    match mumps::build() {
        Ok(()) => println!("cargo:rustc-cfg=mumps"),
        Err(reason) => println!("cargo:warning=built without MUMPS: {reason}"),
    }
}

#[cfg(feature = "mumps")]
mod mumps {
    use std::env;
    use std::process::Command;

    const FACE: &str = "src/condensation/mumps/face.c";

    /// Compiles the face, and tells the linker what it needs.
    pub(super) fn build() -> Result<(), String> {
        for name in ["MPICC", "MUMPS_DIR", "MUMPS_LIBS"] {
            println!("cargo:rerun-if-env-changed={name}");
        }
        println!("cargo:rerun-if-changed={FACE}");
        let mpicc = env::var("MPICC").unwrap_or_else(|_| "mpicc".to_owned());
        let of_mpi = flags(&mpicc)?;
        let mut face = cc::Build::new();
        face.compiler(&mpicc).file(FACE);
        if let Ok(folder) = env::var("MUMPS_DIR") {
            face.include(format!("{folder}/include"));
            println!("cargo:rustc-link-search=native={folder}/lib");
        }
        let built = face.try_compile("dpana_face");
        built.map_err(|error| format!("{FACE}: {error} (Debian: libmumps-dev)"))?;
        let libraries = env::var("MUMPS_LIBS");
        let libraries = libraries.unwrap_or_else(|_| "dmumps mumps_common".to_owned());
        for library in libraries.split_whitespace() {
            println!("cargo:rustc-link-lib=dylib={library}");
        }
        for flag in of_mpi.split_whitespace() {
            if let Some(folder) = flag.strip_prefix("-L") {
                println!("cargo:rustc-link-search=native={folder}");
            } else if let Some(library) = flag.strip_prefix("-l") {
                println!("cargo:rustc-link-lib=dylib={library}");
            }
        }
        Ok(())
    }

    /// What the wrapper hands to the compiler.
    fn flags(mpicc: &str) -> Result<String, String> {
        let shown = Command::new(mpicc).arg("-show").output();
        let shown = shown
            .map_err(|error| format!("{mpicc}: {error} (Debian: libopenmpi-dev, openmpi-bin)"))?;
        match shown.status.success() {
            true => Ok(String::from_utf8_lossy(&shown.stdout).into_owned()),
            false => Err(format!("{mpicc} -show: {}", shown.status)),
        }
    }
}

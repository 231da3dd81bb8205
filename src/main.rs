//! The program `ballast-gpr`; everything is in the library.

fn main() -> std::process::ExitCode {
    ballast_gpr::cli::main()
}

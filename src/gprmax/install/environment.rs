//! The private environment.

use std::fs::{self, File};
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::python::{python_to_install_with, start};
use super::{GPRMAX_VERSION, H5PY_VERSION, InstallError, Interpreter, PYTHON_WITH_GPRMAX, VersionInfo, cache_folder};
use crate::files::{FileError, create_folder, write_bytes};

/// Written last; without it an environment is the rest of an interrupted installation.
const COMPLETE: &str = "ballast-gpr-complete";

/// Installs gprMax into the private environment, unless it is there already.
///
/// `on_line` is told what happens, line by line. Two installations at once wait for each other; one that was interrupted is
/// done again. Needs a network, or a `pip` that is set up to find packages without one.
///
/// # Errors
/// See [`InstallError`]; what `pip` printed is given in full.
pub fn install(on_line: &mut dyn FnMut(&str)) -> Result<Interpreter, InstallError> {
    install_in(&cache_folder()?, &python_to_install_with, on_line)
}

/// As [`install`], into a given cache folder; `base` is only asked for where there is something to install.
fn install_in(
    cache: &Path,
    base: &dyn Fn() -> Result<PathBuf, InstallError>,
    on_line: &mut dyn FnMut(&str),
) -> Result<Interpreter, InstallError> {
    create_folder(cache)?;
    let lock_path = cache.join("gprmax.lock");
    let lock = File::create(&lock_path).map_err(FileError::of("write", &lock_path))?;
    lock.lock().map_err(FileError::of("lock", &lock_path))?;
    let folder = environment(cache);
    if let Some(interpreter) = complete(&folder) {
        return Ok(interpreter);
    }
    if folder.exists() {
        on_line(&format!("removing an unfinished installation in {}", folder.display()));
        fs::remove_dir_all(&folder).map_err(FileError::of("remove", &folder))?;
    }
    let base = base()?;
    on_line(&format!("making an environment for gprMax {GPRMAX_VERSION} in {}", folder.display()));
    step(start(&base).args(["-m", "venv"]).arg(&folder), on_line)?;
    let interpreter = Interpreter { python: python_in(&folder) };
    let packages = [format!("gprMax=={GPRMAX_VERSION}"), format!("h5py=={H5PY_VERSION}")];
    let pip = ["-m", "pip", "install", "--no-input", "--disable-pip-version-check", "--progress-bar", "off"];
    step(interpreter.command().args(pip).args(packages), on_line)?;
    let versions = check(&interpreter)?;
    on_line(&format!("gprMax {} is ready", versions.gprmax));
    write_bytes(&folder.join(COMPLETE), format!("gprMax {}\nh5py {}\n", versions.gprmax, versions.h5py).as_bytes())?;
    Ok(interpreter)
}

/// Finds gprMax: `explicit`, else `$BALLAST_GPR_GPRMAX_PYTHON`, else the private environment. Installs nothing.
///
/// An interpreter named by the user is checked; the private one was checked when it was made.
///
/// # Errors
/// See [`InstallError`].
pub fn find(explicit: Option<&Path>) -> Result<Interpreter, InstallError> {
    let named = std::env::var_os(PYTHON_WITH_GPRMAX).filter(|name| !name.is_empty()).map(PathBuf::from);
    if let Some(python) = explicit.map(Path::to_path_buf).or(named) {
        let interpreter = Interpreter { python };
        check(&interpreter)?;
        return Ok(interpreter);
    }
    let folder = environment(&cache_folder()?);
    complete(&folder).ok_or(InstallError::NotInstalled { folder })
}

/// Starts an interpreter, imports gprMax and asks for the versions.
///
/// # Errors
/// When it does not start, has no gprMax, or one of another main version.
pub fn check(interpreter: &Interpreter) -> Result<VersionInfo, InstallError> {
    let script = "import sys, gprMax, h5py; print('versions', '.'.join(map(str, sys.version_info[:3])), gprMax.__version__, h5py.__version__)";
    let python = interpreter.python.clone();
    let output = interpreter
        .command()
        .args(["-c", script])
        .stdin(Stdio::null())
        .output()
        .map_err(|source| InstallError::NotStarted { python: python.clone(), source })?;
    let text = String::from_utf8_lossy(&output.stdout);
    let words = text.lines().rev().find_map(|line| line.strip_prefix("versions "));
    let words: Vec<&str> = words.unwrap_or("").split_whitespace().collect();
    let [of_python, of_gprmax, of_h5py] = words[..] else {
        let output = format!("{text}{}", String::from_utf8_lossy(&output.stderr));
        return Err(InstallError::NoGprMax { python, output });
    };
    if !of_gprmax.starts_with("4.") {
        return Err(InstallError::WrongVersion { python, found: of_gprmax.into(), wanted: GPRMAX_VERSION });
    }
    Ok(VersionInfo { python: of_python.into(), gprmax: of_gprmax.into(), h5py: of_h5py.into() })
}

fn environment(cache: &Path) -> PathBuf {
    cache.join(format!("gprmax-{GPRMAX_VERSION}"))
}

fn python_in(folder: &Path) -> PathBuf {
    if cfg!(windows) { folder.join("Scripts").join("python.exe") } else { folder.join("bin").join("python") }
}

/// The interpreter of a finished environment.
fn complete(folder: &Path) -> Option<Interpreter> {
    let interpreter = Interpreter { python: python_in(folder) };
    (folder.join(COMPLETE).is_file() && interpreter.python.exists()).then_some(interpreter)
}

/// Runs one step, passes its lines on, and gives all of them when it fails.
fn step(command: &mut Command, on_line: &mut dyn FnMut(&str)) -> Result<(), InstallError> {
    let python = PathBuf::from(command.get_program());
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    let name = words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
    let spawned = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = spawned.map_err(|source| InstallError::NotStarted { python: python.clone(), source })?;
    let errors = child.stderr.take().map(|mut pipe| {
        std::thread::spawn(move || {
            let mut bytes = vec![];
            // What could be read is shown; a pipe that breaks ends with its process, whose status is looked at below.
            let _ = pipe.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        })
    });
    let mut output = String::new();
    for line in child.stdout.take().into_iter().flat_map(|pipe| BufReader::new(pipe).lines()).map_while(Result::ok) {
        on_line(&line);
        output += &line;
        output.push('\n');
    }
    let status = child.wait().map_err(|source| InstallError::NotStarted { python, source })?;
    output += &errors.and_then(|thread| thread.join().ok()).unwrap_or_default();
    if status.success() {
        Ok(())
    } else {
        Err(InstallError::Step { command: name, status: status.to_string(), output })
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt as _;

    /// A Python in name: makes an "environment" by copying itself, "installs" slowly, and knows three versions.
    fn pretender(folder: &Path) -> PathBuf {
        let path = folder.join("python3");
        let script = format!(
            "#!/bin/sh\ncase \"$1 $2\" in\n\
             '-m venv') mkdir -p \"$3/bin\" && cp \"$0\" \"$3/bin/python\" ;;\n\
             '-m pip') sleep 0.3; echo \"$@\" >> '{}' ;;\n\
             *) echo versions 3.11.7 4.0.1 3.16.0 ;;\nesac\n",
            folder.join("installed").display()
        );
        fs::write(&path, script).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    /// Four at once: one installs, the others wait and find it. What is unfinished is made again.
    #[test]
    fn an_environment_is_made_once_and_again_when_unfinished() {
        let folder = tempfile::tempdir().unwrap();
        let (python, cache) = (pretender(folder.path()), folder.path().join("cache"));
        let base = || Ok(python.clone());
        let made = || install_in(&cache, &base, &mut |_| ()).unwrap();
        let all: Vec<_> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..4).map(|_| scope.spawn(made)).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        let wanted = Interpreter { python: python_in(&environment(&cache)) };
        assert!(all.iter().all(|interpreter| *interpreter == wanted));
        let installed = || fs::read_to_string(folder.path().join("installed")).unwrap();
        assert_eq!(installed().lines().count(), 1);
        assert!(installed().ends_with("gprMax==4.0.1 h5py==3.16.0\n"), "{}", installed());

        fs::remove_file(environment(&cache).join(COMPLETE)).unwrap();
        let mut lines = vec![];
        install_in(&cache, &base, &mut |line| lines.push(line.to_owned())).unwrap();
        assert!(lines[0].starts_with("removing an unfinished installation"), "{lines:?}");
        assert_eq!(installed().lines().count(), 2);
    }

    #[test]
    fn an_environment_without_its_marker_is_not_taken() {
        let cache = tempfile::tempdir().unwrap();
        let folder = environment(cache.path());
        fs::create_dir_all(python_in(&folder).parent().unwrap()).unwrap();
        fs::write(python_in(&folder), "").unwrap();
        assert_eq!(complete(&folder), None);
        fs::write(folder.join(COMPLETE), "").unwrap();
        assert_eq!(complete(&folder), Some(Interpreter { python: python_in(&folder) }));
    }

    #[test]
    fn a_failing_step_shows_all_that_it_printed() {
        let mut seen = vec![];
        let script = "echo collecting; echo 'ERROR: no such version' >&2; exit 3";
        let error = step(Command::new("sh").args(["-c", script]), &mut |line| seen.push(line.to_owned())).unwrap_err();
        assert_eq!(seen, ["collecting"]);
        let message = error.to_string();
        assert!(
            message.contains("collecting\nERROR: no such version\n") && message.contains("exit status: 3"),
            "{message}"
        );
    }

    #[test]
    fn a_python_without_gprmax_and_one_of_version_3_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let fake = |name: &str, body: &str| {
            let python = folder.path().join(name);
            fs::write(&python, format!("#!/bin/sh\n{body}\n")).unwrap();
            fs::set_permissions(&python, fs::Permissions::from_mode(0o755)).unwrap();
            check(&Interpreter { python })
        };
        let error = fake("none", "echo \"No module named 'gprMax'\" >&2; exit 1").unwrap_err().to_string();
        assert!(error.contains("cannot import gprMax:\nNo module named 'gprMax'"), "{error}");
        let error = fake("old", "echo versions 3.11.7 3.1.7 3.10.0").unwrap_err().to_string();
        assert!(error.contains("has gprMax 3.1.7, this program needs version 4"), "{error}");
        let found = fake("new", "echo versions 3.11.7 4.0.1 3.16.0").unwrap();
        assert_eq!(found, VersionInfo { python: "3.11.7".into(), gprmax: "4.0.1".into(), h5py: "3.16.0".into() });
    }
}

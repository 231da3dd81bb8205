//! A child process that is told to stop when this program is.

use std::io::{self, Read};
use std::process::{Child, Command, Output, Stdio};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crate::cli::interrupt;

/// How often a child is looked at.
const PAUSE: Duration = Duration::from_millis(10);

/// Runs a command to its end and gives what it printed.
///
/// The child has a process group of its own, so that Ctrl-C on a terminal reaches this program alone, which passes it on once:
/// a second one would make the child end at once and leave its temporary files.
///
/// # Errors
/// What the system said.
pub fn output(command: &mut Command) -> io::Result<Output> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt as _;
        command.process_group(0);
    }
    let mut child = command.spawn()?;
    let (stdout, stderr) = (child.stdout.take().map(read_all), child.stderr.take().map(read_all));
    let mut told = false;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if interrupt::requested() && !told {
            stop(&mut child)?;
            told = true;
        }
        thread::sleep(PAUSE);
    };
    Ok(Output { status, stdout: collect(stdout), stderr: collect(stderr) })
}

/// Asks a child to stop. It has not been waited for, so its number is still its own.
fn stop(child: &mut Child) -> io::Result<()> {
    #[cfg(unix)]
    if Command::new("kill").args(["-INT", &child.id().to_string()]).stderr(Stdio::null()).status()?.success() {
        return Ok(());
    }
    child.kill()
}

fn read_all(mut pipe: impl Read + Send + 'static) -> JoinHandle<Vec<u8>> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // A pipe that breaks gives what came through it; the exit status tells how the child fared.
        let _ = pipe.read_to_end(&mut bytes);
        bytes
    })
}

fn collect(reader: Option<JoinHandle<Vec<u8>>>) -> Vec<u8> {
    reader.and_then(|reader| reader.join().ok()).unwrap_or_default()
}

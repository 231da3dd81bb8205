//! A child process in a group of its own, read line by line, that can be stopped.

use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use super::error::RunError;

/// How long a request to stop may stay unseen while the child prints nothing.
const PATIENCE: Duration = Duration::from_millis(100);

/// What a child did.
pub(super) enum Event<'a> {
    /// It printed a line, ended by a line feed or, in a progress bar, a carriage return.
    Line(&'a str),
    /// It printed nothing for a while.
    Quiet,
}

/// Runs a command and hands out its lines from both streams. `on_event` may ask to stop by giving `false`: the child and its
/// children are then killed and [`RunError::Stopped`] is returned.
pub(super) fn run(command: &mut Command, mut on_event: impl FnMut(Event<'_>) -> bool) -> Result<ExitStatus, RunError> {
    let python = Path::new(command.get_program()).to_path_buf();
    let failed = |source| RunError::NotStarted { python: python.clone(), source };
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt as _;
        command.process_group(0);
    }
    let mut child = Running(command.spawn().map_err(failed)?);
    let (sender, lines) = channel();
    let readers = [
        child.0.stdout.take().map(|pipe| read_lines(pipe, sender.clone())),
        child.0.stderr.take().map(|pipe| read_lines(pipe, sender.clone())),
    ];
    drop(sender);
    hand_out(&lines, &mut on_event)?;
    for reader in readers.into_iter().flatten() {
        // A reader that panicked has closed its end of the channel; the status below tells how the child fared.
        let _ = reader.join();
    }
    child.0.wait().map_err(failed)
}

fn hand_out(lines: &Receiver<String>, on_event: &mut impl FnMut(Event<'_>) -> bool) -> Result<(), RunError> {
    loop {
        let goes_on = match lines.recv_timeout(PATIENCE) {
            Ok(line) => on_event(Event::Line(&line)),
            Err(RecvTimeoutError::Timeout) => on_event(Event::Quiet),
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        };
        if !goes_on {
            return Err(RunError::Stopped);
        }
    }
}

/// Splits a stream at line feeds and carriage returns.
fn read_lines(mut pipe: impl Read + Send + 'static, sender: Sender<String>) -> std::thread::JoinHandle<()> {
    std::thread::spawn(move || {
        let (mut buffer, mut line) = ([0; 4096], vec![]);
        while let Ok(count @ 1..) = pipe.read(&mut buffer) {
            for &byte in &buffer[..count] {
                if byte != b'\n' && byte != b'\r' {
                    line.push(byte);
                } else if sender.send(String::from_utf8_lossy(&std::mem::take(&mut line)).into_owned()).is_err() {
                    return;
                }
            }
        }
        if !line.is_empty() {
            let _ = sender.send(String::from_utf8_lossy(&line).into_owned());
        }
    })
}

/// A child that does not outlive this value.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        if matches!(self.0.try_wait(), Ok(Some(_))) {
            return;
        }
        // The child has not been waited for, so its number, and that of its group, is still its own.
        #[cfg(unix)]
        let _ = Command::new("kill")
            .args(["-KILL", "--", &format!("-{}", self.0.id())])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn lines_of_both_streams_are_handed_out() {
        let mut seen = vec![];
        let mut command = Command::new("sh");
        command.args(["-c", "printf 'a\\rb\\nc'; echo d >&2; exit 3"]);
        let status = run(&mut command, |event| {
            if let Event::Line(line) = event {
                seen.push(line.to_owned());
            }
            true
        });
        seen.sort();
        assert_eq!(seen, ["a", "b", "c", "d"]);
        assert_eq!(status.unwrap().code(), Some(3));
    }

    /// A child of the child, which prints nothing, is stopped too.
    #[test]
    fn a_request_to_stop_ends_the_whole_group() {
        let folder = tempfile::tempdir().unwrap();
        let mark = folder.path().join("survived");
        let mut command = Command::new("sh");
        command.args(["-c", &format!("(sleep 2; touch '{}') & echo started; wait", mark.display())]);
        let begin = Instant::now();
        let mut started = false;
        let result = run(&mut command, |event| {
            started |= matches!(event, Event::Line("started"));
            !(started && matches!(event, Event::Quiet))
        });
        assert!(matches!(result, Err(RunError::Stopped)));
        assert!(begin.elapsed() < Duration::from_millis(1900), "{:?}", begin.elapsed());
        std::thread::sleep(Duration::from_millis(2300));
        assert!(!mark.exists());
    }
}

//! From text to commands.

use super::commands::{COMMANDS, CommandKind, kind_of};
use super::error::Problem;
use crate::files::nearest_name;

/// One command of an input file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Command<'a> {
    /// Line number, from 1.
    pub line: usize,
    /// Name without `#`.
    pub name: &'a str,
    /// What stands behind the colon, trimmed.
    pub parameters: &'a str,
    /// What becomes of it.
    pub kind: CommandKind,
}

/// Splits a text into commands, in the order of the file. Also gives the lines that gprMax ignores because a blank stands
/// before the `#`.
pub(super) fn split(text: &str) -> Result<(Vec<Command<'_>>, Vec<usize>), (usize, Problem)> {
    let mut commands: Vec<Command<'_>> = vec![];
    let mut indented = vec![];
    for (index, raw) in text.lines().enumerate() {
        let line = index + 1;
        let raw = raw.trim_end();
        if !raw.starts_with('#') || raw.starts_with("##") {
            if raw.trim_start().starts_with('#') && !raw.trim_start().starts_with("##") {
                indented.push(line);
            }
            continue;
        }
        let (name, rest) = raw.split_once(':').ok_or_else(|| (line, Problem::NoColon { text: shortened(raw) }))?;
        let name = &name[1..];
        let kind = kind_of(name).ok_or_else(|| {
            let nearest = nearest_name(name, COMMANDS.iter().map(|(known, _)| *known));
            (line, Problem::Unknown { command: shortened(name), nearest })
        })?;
        if !rest.is_empty() && !rest.starts_with(' ') {
            return Err((line, Problem::NoSpace { command: name.into() }));
        }
        match kind {
            CommandKind::Retired(instead) => return Err((line, Problem::Retired { command: name.into(), instead })),
            CommandKind::GprMaxOnly => return Err((line, Problem::Unsupported { command: name.into() })),
            CommandKind::Multiple => {}
            CommandKind::Noted(_) if name != "output_dir" => {}
            CommandKind::Single | CommandKind::Noted(_) => {
                if let Some(first) = commands.iter().find(|earlier| alias(earlier.name) == alias(name)) {
                    return Err((line, Problem::Duplicate { command: name.into(), first: first.line }));
                }
            }
        }
        commands.push(Command { line, name, parameters: rest.trim(), kind });
    }
    Ok((commands, indented))
}

/// `#num_threads` is an old name of `#omp_threads`; only one of them may stand.
fn alias(name: &str) -> &str {
    if name == "num_threads" { "omp_threads" } else { name }
}

/// A text short enough for a message.
fn shortened(text: &str) -> String {
    if text.chars().count() <= 60 {
        return text.into();
    }
    text.chars().take(57).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_blank_lines_and_other_lines_are_passed_over() {
        let text = "## a comment\nfree text\n\n#title: a: b \n #box: 1\n#domain: 1 2 3\r\n";
        let (commands, indented) = split(text).unwrap();
        assert_eq!(commands.len(), 2);
        assert_eq!((commands[0].line, commands[0].name, commands[0].parameters), (4, "title", "a: b"));
        assert_eq!((commands[1].name, commands[1].parameters), ("domain", "1 2 3"));
        assert_eq!(indented, [5]);
    }

    #[test]
    fn each_wrong_line_is_named() {
        let message = |text: &str| split(text).map(|_| ()).map_err(|(line, problem)| format!("{line}: {problem}"));
        let of = |text: &str| message(text).unwrap_err();
        assert_eq!(
            of("\n#domain 1 2 3"),
            "2: a colon is missing behind the command in `#domain 1 2 3`\n\nhint: `#command: parameters`"
        );
        assert_eq!(of("#domain:1 2 3"), "1: a space is missing behind the colon of `#domain:`");
        assert_eq!(of("#cilinder: 1"), "1: `#cilinder` is not a gprMax command\n\nhint: did you mean `#cylinder`?");
        assert_eq!(of("#xyzzyplugh: 1"), "1: `#xyzzyplugh` is not a gprMax command");
        assert_eq!(
            of("#thin_wire: 1"),
            "1: `#thin_wire` is not supported by the embedded solver\n\nhint: `--solver gprmax` runs the file in gprMax itself"
        );
        assert_eq!(of("#title: a\n#title: b"), "2: `#title` stands for the second time, first in line 1");
        assert_eq!(
            of("#omp_threads: 1\n#num_threads: 1"),
            "2: `#num_threads` stands for the second time, first in line 1"
        );
        assert!(of("#rx_port: 1").contains("is not a command of gprMax 4"));
    }
}

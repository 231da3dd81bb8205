//! Putting the files of `#include_file` in place of the commands that name them.

use std::path::{Path, PathBuf};

use super::error::{InFileError, Problem};
use crate::files::read_text;

/// The most files that may be included in all.
const MOST_FILES: usize = 1000;
/// The most characters of all files together.
const MOST_TEXT: usize = 1 << 30;

/// An input file with all that it includes, as one text.
pub(super) struct Whole {
    pub text: String,
    /// The files, the input file first.
    files: Vec<PathBuf>,
    /// File and line of each line of the text.
    places: Vec<Place>,
}

/// Where a line stands.
#[derive(Debug, Clone, Copy)]
struct Place {
    file: usize,
    line: usize,
    /// The line of the input file that leads here.
    outer: usize,
}

impl Whole {
    /// Reads an input file and what it includes. Paths are relative to the file that names them, as in gprMax.
    ///
    /// # Errors
    /// A file that cannot be read, or that includes itself.
    pub fn read(path: &Path) -> Result<Self, InFileError> {
        let mut whole = Self { text: String::new(), files: vec![path.into()], places: vec![] };
        whole.take(0, None, &mut vec![])?;
        Ok(whole)
    }

    fn take(&mut self, file: usize, outer: Option<usize>, chain: &mut Vec<PathBuf>) -> Result<(), InFileError> {
        let path = self.files[file].clone();
        let text = read_text(&path)?;
        chain.push(path.canonicalize().unwrap_or_else(|_| path.clone()));
        for (index, raw) in text.lines().enumerate() {
            let line = index + 1;
            let at = |problem| InFileError::Line { path: path.clone(), line, problem: Box::new(problem) };
            let Some(names) = raw.strip_prefix("#include_file: ") else {
                if self.text.len() + raw.len() > MOST_TEXT {
                    return Err(at(Problem::TooMuchIncluded { files: self.files.len() }));
                }
                self.text.extend([raw, "\n"]);
                self.places.push(Place { file, line, outer: outer.unwrap_or(line) });
                continue;
            };
            let names: Vec<_> = names.split_whitespace().collect();
            let [name] = names.as_slice() else {
                let (command, found, form) = ("include_file".into(), names.len(), "FILE");
                return Err(at(Problem::Parameters { command, found, form }));
            };
            let included = path.with_file_name("").join(name);
            let known = included.canonicalize().unwrap_or_else(|_| included.clone());
            if chain.contains(&known) {
                return Err(at(Problem::IncludesItself { file: (*name).into() }));
            }
            if self.files.len() > MOST_FILES {
                return Err(at(Problem::TooMuchIncluded { files: self.files.len() }));
            }
            self.files.push(included);
            self.take(self.files.len() - 1, Some(outer.unwrap_or(line)), chain).map_err(|error| match error {
                InFileError::File(error) => at(Problem::File(error)),
                other => other,
            })?;
        }
        chain.pop();
        Ok(())
    }

    fn place(&self, line: usize) -> Option<(&Path, Place)> {
        let place = self.places.get(line.checked_sub(1)?)?;
        Some((&self.files[place.file], *place))
    }

    /// An error about a line of the text, as one about the line of its file.
    pub fn error(&self, error: InFileError) -> InFileError {
        let InFileError::Line { path, line, mut problem } = error else { return error };
        if let Problem::Duplicate { first, .. } = &mut *problem {
            *first = self.place(*first).map_or(*first, |(_, place)| place.line);
        }
        let (path, line) = self.place(line).map_or((path, line), |(file, place)| (file.into(), place.line));
        InFileError::Line { path, line, problem }
    }

    /// A line of the text as the line of the input file that leads to it, and where it stands if that is another file.
    pub fn note(&self, line: usize) -> (usize, String) {
        match self.place(line) {
            Some((_, place)) if place.file == 0 => (place.line, String::new()),
            Some((file, place)) => (place.outer, format!("in `{}` line {}: ", file.display(), place.line)),
            None => (line, String::new()),
        }
    }

    /// The input file, those it includes, and those that its commands read.
    pub fn files(&self) -> Vec<PathBuf> {
        let beside = self.files[0].with_file_name("");
        let mut files = self.files.clone();
        for line in self.text.lines() {
            let word = |index: usize| line.split_whitespace().nth(index);
            if line.starts_with("#excitation_file: ") {
                files.extend(word(1).map(|name| beside.join(name)));
            } else if line.starts_with("#geometry_objects_read: ") {
                files.extend(word(4).map(|name| beside.join(name)));
                files.extend(word(5).map(|name| beside.join(format!("{name}.json"))));
            }
        }
        files
    }
}

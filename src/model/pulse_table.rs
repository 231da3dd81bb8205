//! Pulses as columns of text: gprMax's `#excitation_file`.

/// What a file of pulses holds: names in the first row, numbers below.
#[derive(Debug, Clone, PartialEq)]
pub struct PulseTable {
    /// The first column, s, where it is called `time`.
    pub times: Option<Vec<f64>>,
    /// Name and samples of each pulse.
    pub pulses: Vec<(String, Vec<f64>)>,
}

/// Why a text is no table of pulses.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct PulseTableError {
    /// Line, counted from 1.
    pub line: usize,
    /// What is wrong there.
    pub what: String,
}

impl PulseTable {
    /// Reads the text of a file. Lines without anything on them do not count.
    ///
    /// # Errors
    /// Rows of another length than the first, words that are no finite numbers, no name, fewer than two samples.
    pub fn read(text: &str) -> Result<Self, PulseTableError> {
        let wrong = |line: usize, what: String| PulseTableError { line, what };
        let mut rows = text.lines().enumerate().filter(|(_, row)| !row.trim().is_empty());
        let names: Vec<&str> = rows.next().map_or(vec![], |(_, row)| row.split_whitespace().collect());
        let mut columns = vec![vec![]; names.len()];
        for (index, row) in rows {
            let line = index + 1;
            let words: Vec<_> = row.split_whitespace().collect();
            if words.len() != names.len() {
                return Err(wrong(
                    line,
                    format!("there are {} numbers, but {} names in the first line", words.len(), names.len()),
                ));
            }
            for (column, word) in columns.iter_mut().zip(words) {
                let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
                column.push(number.ok_or_else(|| wrong(line, format!("`{word}` is not a number")))?);
            }
        }
        let timed = names.first() == Some(&"time");
        if names.len() < 1 + usize::from(timed) {
            return Err(wrong(1, "there is no name of a pulse".into()));
        }
        let samples = columns[0].len();
        if samples < 2 {
            return Err(wrong(samples + 1, format!("there are {samples} samples, at least 2 are needed")));
        }
        let times = timed.then(|| columns.remove(0));
        let pulses = names.into_iter().skip(usize::from(timed)).map(String::from).zip(columns).collect();
        Ok(Self { times, pulses })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_with_and_without_times() {
        let table = PulseTable::read("time a b\n0 1 2\n\n1e-9 3 4\n").unwrap();
        assert_eq!(table.times, Some(vec![0.0, 1e-9]));
        assert_eq!(table.pulses, [("a".to_string(), vec![1.0, 3.0]), ("b".to_string(), vec![2.0, 4.0])]);
        assert_eq!(PulseTable::read("a\n1\n2\n").unwrap().times, None);
        assert_eq!(PulseTable::read("time a\n0 x\n").unwrap_err().to_string(), "line 2: `x` is not a number");
    }
}

//! What an experiment came to: figures, curves, stones.

use serde::{Deserialize, Serialize};

use crate::geometry::Sphere;

/// A number with its name and unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reading {
    /// Name in JSON.
    pub key: String,
    /// What it is, with its unit.
    pub quantity: String,
    /// The number.
    pub value: f64,
    /// Decimals to show.
    pub decimals: usize,
}

impl Reading {
    /// Makes one.
    pub fn new(key: &str, quantity: &str, value: f64, decimals: usize) -> Self {
        Self { key: key.into(), quantity: quantity.into(), value, decimals }
    }
}

/// A curve: columns with names, rows of numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Curve {
    /// Names of the columns, with their units: `time_s`, `force_n`.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

impl Curve {
    /// A curve without rows.
    pub fn new(columns: &[&str]) -> Self {
        Self { columns: columns.iter().map(ToString::to_string).collect(), rows: vec![] }
    }

    /// The column of a name; empty when there is none.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let at = self.columns.iter().position(|column| column == name);
        at.map_or(vec![], |at| self.rows.iter().filter_map(|row| row.get(at).copied()).collect())
    }

    /// Two columns as points.
    pub fn points(&self, x: &str, y: &str) -> Vec<(f64, f64)> {
        self.column(x).into_iter().zip(self.column(y)).collect()
    }

    /// The curve as CSV, with the shortest digits that read back to the same bits.
    pub fn csv(&self) -> String {
        let mut text = self.columns.join(",");
        text.push('\n');
        for row in &self.rows {
            let cells: Vec<_> = row.iter().map(f64::to_string).collect();
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }
}

/// What an experiment came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the experiment.
    pub experiment: String,
    /// Its numbers.
    pub readings: Vec<Reading>,
    /// Its curve.
    pub curve: Curve,
    /// What must be said beside them: departures, warnings, what was assumed.
    pub notes: Vec<String>,
    /// The stones at the end, where they are worth keeping.
    pub stones: Vec<Sphere>,
}

impl Outcome {
    /// The reading of a key.
    pub fn reading(&self, key: &str) -> Option<f64> {
        self.readings.iter().find(|reading| reading.key == key).map(|reading| reading.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_written_with_all_digits() {
        let mut curve = Curve::new(&["time_s", "force_n"]);
        curve.rows.push(vec![0.1, 1.0 / 3.0]);
        assert_eq!(curve.csv(), "time_s,force_n\n0.1,0.3333333333333333\n");
        assert_eq!(curve.points("time_s", "force_n"), [(0.1, 1.0 / 3.0)]);
        assert!(curve.column("none").is_empty());
    }
}

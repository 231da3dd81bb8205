//! Tables on standard output, and the same as JSON.

use comfy_table::presets::UTF8_HORIZONTAL_ONLY;
use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table};

/// Width of a table that is not printed on a terminal, characters.
const WIDTH: u16 = 150;

/// A table to print.
pub struct Report {
    title: String,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
    /// Cells by row and column that Markdown shows otherwise, because they differ from machine to machine.
    elsewhere: Vec<(usize, usize, String)>,
}

impl Report {
    /// A table with a title and column heads.
    pub fn new<const N: usize>(title: impl Into<String>, header: [&str; N]) -> Self {
        Self {
            title: title.into(),
            header: header.iter().map(ToString::to_string).collect(),
            rows: vec![],
            elsewhere: vec![],
        }
    }

    /// Adds a row.
    pub fn row<const N: usize>(&mut self, cells: [String; N]) {
        self.rows.push(cells.into());
    }

    /// Says how Markdown, which is kept and compared, shows a cell of the last row that differs from machine to machine.
    pub fn in_markdown(&mut self, column: usize, text: impl Into<String>) {
        self.elsewhere.push((self.rows.len().saturating_sub(1), column, text.into()));
    }

    /// The title.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The heads of the columns.
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// The rows.
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// Prints the table on standard output.
    pub fn print(&self) {
        println!("{}", self.title);
        let mut table = Table::new();
        let rule = LineStyle::none().fill('─').junction('─');
        let style = UTF8_HORIZONTAL_ONLY.header_separator(rule).row_separator(LineStyle::none());
        table.load_style(style).set_content_arrangement(ContentArrangement::Dynamic);
        if table.width().is_none() {
            table.set_width(WIDTH);
        }
        table.set_header(self.header.clone());
        for row in &self.rows {
            table.add_row(row.clone());
        }
        for (index, column) in table.column_iter_mut().enumerate() {
            let numeric = self.rows.iter().all(|row| {
                row.get(index).is_none_or(|cell| {
                    cell.is_empty()
                        || cell == "–"
                        || cell.starts_with(|c: char| c.is_ascii_digit() || "+-−".contains(c))
                })
            });
            if index > 0 && numeric {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        println!("{table}");
    }

    /// The same as JSON: one object per row, by column heads.
    pub fn json(&self) -> serde_json::Value {
        let row = |cells: &Vec<String>| {
            self.header
                .iter()
                .cloned()
                .zip(cells.iter().cloned().map(Into::into))
                .collect::<serde_json::Map<_, _>>()
                .into()
        };
        self.rows.iter().map(row).collect::<Vec<serde_json::Value>>().into()
    }

    /// The same as Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            format!("| {} |\n", cells.iter().map(|c| c.replace('\n', " ")).collect::<Vec<_>>().join(" | "))
        };
        let mut text = line(&self.header);
        text.push_str(&format!("|{}\n", "---|".repeat(self.header.len())));
        for (index, row) in self.rows.iter().enumerate() {
            let mut row = row.clone();
            for (_, column, shown) in self.elsewhere.iter().filter(|(at, _, _)| *at == index) {
                if let Some(cell) = row.get_mut(*column) {
                    cell.clone_from(shown);
                }
            }
            text.push_str(&line(&row));
        }
        text
    }
}

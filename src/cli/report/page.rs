//! What the template of the page sees.

use minijinja::{AutoEscape, Environment, UndefinedBehavior};

use crate::cli::error::{CliError, Kind};
use crate::cli::table::Report;
use crate::plot::{self, Figure};

const TEMPLATE: &str = include_str!("../../../templates/report.html");

/// The page.
#[derive(Debug, serde::Serialize)]
pub struct Page {
    /// Program, version and commit.
    pub program: String,
    /// Title.
    pub title: String,
    /// One for each folder.
    pub models: Vec<Model>,
    /// One for each pair of traces.
    pub comparisons: Vec<Compared>,
}

/// A folder.
#[derive(Debug, serde::Serialize)]
pub struct Model {
    /// Anchor.
    pub id: String,
    /// Name of the folder.
    pub name: String,
    /// Title of the scene.
    pub title: String,
    /// One line.
    pub summary: String,
    /// The scene's chief quantities.
    pub scene: Table,
    /// `scene.toml`.
    pub toml: String,
    /// Figures of the packing.
    pub packing: Table,
    /// Its pictures.
    pub packing_figures: Vec<Picture>,
    /// The map.
    pub map: Vec<Picture>,
    /// Layers and arrivals.
    pub layers: Table,
    /// The trace.
    pub traces: Vec<Picture>,
    /// Permittivities.
    pub estimates: Vec<Table>,
    /// What is missing, and why.
    pub notes: Vec<String>,
    /// Effects.
    pub effects: Table,
    /// Wall times.
    pub cost: Table,
    /// `manifest.json`.
    pub manifest: String,
}

/// Two traces.
#[derive(Debug, serde::Serialize)]
pub struct Compared {
    /// Their names.
    pub title: String,
    /// How they were brought together.
    pub how: String,
    /// Traces, residual, envelopes, spectra.
    pub figure: Picture,
    /// The metrics.
    pub metrics: Table,
    /// What was done to each.
    pub steps: Vec<String>,
}

/// A table.
#[derive(Debug, Default, serde::Serialize)]
pub struct Table {
    caption: String,
    header: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

#[derive(Debug, serde::Serialize)]
struct Cell {
    text: String,
    number: bool,
}

impl Table {
    /// A table of names and values.
    pub fn of<const N: usize>(caption: &str, header: [&str; N], rows: Vec<[String; N]>) -> Self {
        let mut report = Report::new(caption, header);
        for row in rows {
            report.row(row);
        }
        Self::from(&report)
    }
}

impl From<&Report> for Table {
    fn from(report: &Report) -> Self {
        let cell = |text: &String| Cell {
            number: text.starts_with(|c: char| c.is_ascii_digit() || "+-−–".contains(c)),
            text: text.clone(),
        };
        Self {
            caption: report.title().into(),
            header: report.header().to_vec(),
            rows: report.rows().iter().map(|row| row.iter().map(cell).collect()).collect(),
        }
    }
}

/// A picture inside the page.
#[derive(Debug, serde::Serialize)]
pub struct Picture {
    /// What it shows, in words.
    alt: String,
    /// The SVG file in base64: as an image it can run nothing and load nothing.
    base64: String,
}

impl Picture {
    /// From the text of an SVG file.
    pub fn of_svg(alt: &str, svg: &str) -> Self {
        Self { alt: alt.into(), base64: plot::base64(svg.as_bytes()) }
    }

    /// From a figure.
    ///
    /// # Errors
    /// When the figure contradicts itself.
    pub fn of(alt: &str, figure: &dyn Figure) -> Result<Self, CliError> {
        Ok(Self::of_svg(alt, &figure.svg()?))
    }
}

impl Page {
    /// The text of the page; everything that comes from outside is escaped.
    ///
    /// # Errors
    /// When template and page disagree, a fault of this program.
    pub fn render(&self) -> Result<String, CliError> {
        let fault = |error: minijinja::Error| CliError::new(Kind::Fault, format!("the page cannot be made: {error:#}"));
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        environment.add_template("report.html", TEMPLATE).map_err(fault)?;
        let template = environment.get_template("report.html").map_err(fault)?;
        template.render(minijinja::value::Serde(self)).map_err(fault)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A title that is markup stays text.
    #[test]
    fn what_comes_from_outside_is_escaped() {
        let page = Page {
            program: "p".into(),
            title: "<script>alert(1)</script> & \"more\"".into(),
            models: vec![],
            comparisons: vec![],
        };
        let html = page.render().unwrap();
        assert!(!html.contains("<script"), "{html}");
        assert!(html.contains("&lt;script&gt;alert(1)&lt;&#x2f;script&gt; &amp; &quot;more&quot;"), "{html}");
    }
}

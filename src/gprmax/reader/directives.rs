//! What only the embedded solver reads: comments of the form `## ballast-gpr: order 4`, which gprMax passes over.

use super::error::Problem;
use crate::model::{Averaging, Order};

/// What such a comment begins with.
pub(in super::super) const DIRECTIVE: &str = "## ballast-gpr:";

/// What such comments ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Directives {
    /// Order of the differences in space.
    pub order: Order,
    /// How edges between materials get their values.
    pub averaging: Averaging,
}

/// Reads them off a text; with the line on error.
pub(super) fn directives(text: &str) -> Result<Directives, (usize, Problem)> {
    let mut asked = Directives::default();
    for (index, line) in text.lines().enumerate() {
        let Some(rest) = line.trim_end().strip_prefix(DIRECTIVE) else { continue };
        let unknown = || (index + 1, Problem::Directive { text: rest.trim().into() });
        match rest.trim().split_once(' ') {
            Some(("order", number)) => asked.order = number.parse().map_err(|_| unknown())?,
            Some(("averaging", "cells")) => asked.averaging = Averaging::Cells,
            Some(("averaging", "volumes")) => asked.averaging = Averaging::Volumes,
            Some(("averaging", "shapes")) => asked.averaging = Averaging::Shapes,
            Some(("averaging", "tensors")) => asked.averaging = Averaging::Tensors,
            _ => return Err(unknown()),
        }
    }
    Ok(asked)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_averaging_stand_in_comments() {
        assert_eq!(directives("#title: a\n## a comment\n").unwrap(), Directives::default());
        let both = "## ballast-gpr: order 4\r\n## ballast-gpr: averaging shapes\n";
        assert_eq!(directives(both).unwrap(), Directives { order: Order::Fourth, averaging: Averaging::Shapes });
        let tensors = directives("## ballast-gpr: averaging tensors\n").unwrap();
        assert_eq!(tensors.averaging, Averaging::Tensors);
        for wrong in ["order 3", "averaging", "speed 9"] {
            let (line, problem) = directives(&format!("\n## ballast-gpr: {wrong}")).unwrap_err();
            assert_eq!(line, 2);
            let start = format!("`{wrong}` is nothing that the embedded solver can be told");
            assert!(problem.to_string().starts_with(&start), "{problem}");
        }
    }
}

//! What only the embedded solver reads: comments of the form `## ballast-gpr: order 4`, which gprMax passes over.

use super::error::Problem;
use crate::model::Order;

/// What such a comment begins with.
pub(in super::super) const DIRECTIVE: &str = "## ballast-gpr:";

/// The order of differences that a file asks for, with the line on error.
pub(super) fn order(text: &str) -> Result<Order, (usize, Problem)> {
    let mut order = Order::Second;
    for (index, line) in text.lines().enumerate() {
        let Some(rest) = line.trim_end().strip_prefix(DIRECTIVE) else { continue };
        let wanted = rest.trim().strip_prefix("order ").and_then(|number| number.parse().ok());
        order = wanted.ok_or_else(|| (index + 1, Problem::Directive { text: rest.trim().into() }))?;
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_stands_in_a_comment() {
        assert_eq!(order("#title: a\n## a comment\n").unwrap(), Order::Second);
        assert_eq!(order("## written by ballast-gpr 1\n## ballast-gpr: order 4\r\n").unwrap(), Order::Fourth);
        let (line, problem) = order("\n## ballast-gpr: order 3").unwrap_err();
        assert_eq!(line, 2);
        assert!(problem.to_string().starts_with("`order 3` is nothing that the embedded solver can be told"));
    }
}

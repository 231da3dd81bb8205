//! The text file of the paper (section 4.3).

use std::fmt::Write as _;

use crate::packing::grading::ClassReading;
use crate::packing::run::{RsaInput, RsaOutcome};

/// Writes what the paper's text file holds: the input, the list of stones, the run time and their number.
///
/// The stones are those after compaction; lengths in metres, digits that read back to the same bits. The run time makes
/// this text differ from run to run; the list does not.
pub fn text_report(input: &RsaInput, outcome: &RsaOutcome) -> String {
    let after = &outcome.after;
    let mut text = String::from("RSA packing of railway ballast, method of Benedetto et al. 2018\n\nInput\n");
    let mut line = |label: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{label:<34}{value}");
    };
    let percent = |share: f64, digits: usize| format!("{:.digits$} %", share * 100.0);
    line("width of the bed", input.width.to_string());
    line("real height of the bed", input.height.to_string());
    line("voids", input.voids.void_share().to_string());
    line("compaction rate P_c", percent(input.voids.solid_share().si(), 2));
    line("grading", input.grading.name().into());
    for sieve in input.grading.sieves() {
        line(&format!("  passes {}", sieve.size.in_unit("mm")), sieve.passing.to_string());
    }
    let reading = match input.class_reading {
        ClassReading::En933 => "en-933-1",
        ClassReading::OneSieveUp => "one-sieve-up",
    };
    line("class reading", reading.into());
    line("input height", format!("{:.4} m", outcome.input_height.si()));
    line("input compaction rate", percent(outcome.input_solid_share.si(), 2));
    line("strip height", input.strip.in_unit("cm"));
    line("seed", after.seed.map_or_else(|| "none".into(), |seed| seed.to_string()));
    line("\nOutput", String::new());
    line("final height", format!("{:.4} m", after.top().si()));
    line("final compaction rate", percent(after.solid_share().si(), 2));
    line("final compaction rate, interior", percent(after.interior_solid_share().si(), 2));
    line("smallest diameter", format!("{:.2} mm", after.smallest_diameter().si() * 1e3));
    line("largest diameter", format!("{:.2} mm", after.largest_diameter().si() * 1e3));
    line("sizing and positioning", format!("{:.6} s", outcome.seconds_positioning.si()));
    line("compaction", format!("{:.6} s", outcome.seconds_compaction.si()));
    line("number of particles", after.count().to_string());
    line("\nx [m], y [m], radius [m]", String::new());
    for disc in &after.discs {
        let _ = writeln!(text, "{} {} {}", disc.x, disc.y, disc.radius);
    }
    let trimmed: Vec<&str> = text.lines().map(str::trim_end).collect();
    trimmed.join("\n") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::pack;

    #[test]
    fn the_report_holds_what_the_paper_lists() {
        let input = RsaInput::benedetto2018().unwrap();
        let outcome = pack(&input, 3).unwrap();
        let text = text_report(&input, &outcome);
        for wanted in [
            "compaction rate P_c               58.00 %",
            "  passes 31.5 mm                  1.2%",
            "input height                      0.5534 m",
        ] {
            assert!(text.contains(wanted), "{wanted}\n{text}");
        }
        assert!(text.contains(&format!("number of particles               {}\n", outcome.after.count())));
        let (_, list) = text.split_once("x [m], y [m], radius [m]\n").unwrap();
        let read: Vec<Vec<f64>> = list.lines().map(|l| l.split(' ').map(|v| v.parse().unwrap()).collect()).collect();
        assert_eq!(read.len(), outcome.after.count());
        let last = outcome.after.discs.last().unwrap();
        assert_eq!(read.last().unwrap(), &[last.x, last.y, last.radius]);
    }
}

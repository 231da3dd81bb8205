//! How far each estimate of the permittivity is from that of the bed: tanks of stones, many seeds, both polarisations and space.

use std::path::Path;

use crate::cli::error::CliError;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::settle;
use crate::cli::table::Report;
use crate::cli::validate::CaseReport;
use crate::fdtd::Fdtd;
use crate::files;
use crate::forward::Progress;
use crate::packing::SphereBed;
use crate::plot::{Axis, Chart, Figure as _, Panels, ReferenceLine, Series, Stroke};
use crate::scene::{self, PackingMethod, SceneSpec};
use crate::study::{Beds, BiasRow, MeanAndSpread, Waves, bias_rows};
use crate::units::Metres;

/// Seeds of the tank of discs.
const SEEDS: u64 = 20;
/// Sections through the bed of spheres, along and across, each with the antenna above another place.
const SECTIONS: [usize; 2] = [3, 7];
/// Places of the antenna above the bed in space.
const PLACES: [[f64; 2]; 3] = [[0.4, 0.4], [0.5, 0.5], [0.6, 0.6]];
/// Cells of all models, so that they differ in their waves alone: 23 a wavelength of the stones at the centre frequency.
const CELL: Metres = Metres(0.005);

/// Runs every bed.
pub fn validate(out: Option<&Path>, bed: Option<&Path>) -> Result<CaseReport, CliError> {
    let solver = Fdtd::default();
    let heights = [0.0, 0.1, 0.2, 0.3].map(Metres);
    let bar = Bar::new("beds");
    let mut tank = SceneSpec::preset("tank")?;
    tank.grid.cell = CELL;
    tank.tank.width = Metres(1.0);
    tank.grid.time_window = crate::units::Seconds(14e-9);
    let mut piece = SceneSpec::preset("bed")?;
    piece.grid.cell = CELL;
    let bed = match bed {
        Some(file) => {
            piece.packing.method = PackingMethod::File;
            piece.packing.file = Some(file.into());
            let found = scene::resolve(&piece)?.spheres;
            found.ok_or_else(|| CliError::input(format!("`{}` holds no spheres", file.display())))?
        }
        None => settle::settle_bed(&piece, None)?.bed,
    };
    let beds = [SphereBed { size: [bed.size[0], bed.size[1], piece.tank.height], ..bed }];
    let mut section = piece.clone();
    // As in the tank of discs.
    section.grid.smoothing = tank.grid.smoothing;
    let share = |k: usize, of: usize| (k as f64 + 0.5) / of as f64;
    let [along, across] = SECTIONS;
    let sections: Vec<[f64; 2]> =
        (0..along).flat_map(|i| (0..across).map(move |k| [0.3 + 0.4 * share(i, along), share(k, across)])).collect();
    let groups = [
        ("tank of discs (RSA)", &tank, Beds::Seeds(SEEDS), Waves::TransverseMagnetic),
        ("tank of discs (RSA)", &tank, Beds::Seeds(SEEDS), Waves::TransverseElectric),
        ("sections of spheres", &section, Beds::Spheres(&beds, &sections), Waves::TransverseMagnetic),
        ("sections of spheres", &section, Beds::Spheres(&beds, &sections), Waves::TransverseElectric),
        ("spheres", &piece, Beds::Spheres(&beds, &PLACES), Waves::Space),
    ];
    let mut rows = vec![];
    for (number, (name, spec, beds, waves)) in groups.into_iter().enumerate() {
        let found = bias_rows(&solver, name, spec, beds, waves, &heights, &|progress: Progress| {
            let parts = 100.0 * progress.done as f64 / progress.total.max(1) as f64;
            let _ = bar.update_with(Progress { done: 100 * number + parts as usize, total: 500 }, || {
                format!("{name}, {}", waves.name())
            });
            interrupt::flow()
        })?;
        rows.extend(found);
        if let Some(folder) = out {
            files::write_bytes(&folder.join("permittivity-bias.csv"), csv(&rows).as_bytes())?;
        }
    }
    drop(bar);
    if let Some(folder) = out {
        figure(&rows).write(folder, "permittivity-bias")?;
    }
    report(&rows)
}

fn report(rows: &[BiasRow]) -> Result<CaseReport, CliError> {
    let title =
        "permittivity-bias: estimate against the mixture (CRIM) of what is in the bed, %, mean ± standard deviation";
    let mut table = Report::new(
        title,
        [
            "bed",
            "waves",
            "fouled, cm",
            "beds",
            "mixture",
            "TDSP, waveform",
            "TDSP, envelope",
            "TDSP, base alone",
            "SRM, top layer",
            "CRIM, nominal voids",
        ],
    );
    let show = |found: &Option<MeanAndSpread>| {
        found.as_ref().map_or("–".into(), |s| format!("{:+.1} ± {:.1}", s.mean, s.standard_deviation))
    };
    for row in rows {
        let picked = row.readings.len();
        table.row([
            row.bed.clone(),
            row.waves.name().into(),
            format!("{:.0}", row.fouling_cm),
            format!("{picked} of {}", picked + row.not_picked),
            row.truth.as_ref().map_or("–".into(), |truth| format!("{:.2}", truth.mean)),
            show(&row.delay_waveform),
            show(&row.delay_envelope),
            show(&row.delay_base),
            show(&row.reflection),
            show(&row.mixture),
        ]);
    }
    let json = rows.iter().map(|row| {
        let mut value = serde_json::to_value(row)?;
        if let Some(object) = value.as_object_mut() {
            object.remove("readings");
        }
        Ok(value)
    });
    let json = json.collect::<Result<Vec<_>, serde_json::Error>>()?;
    Ok(CaseReport { title: title.into(), table, json: json.into(), misses: 0 })
}

/// Every reading, a line each.
fn csv(rows: &[BiasRow]) -> String {
    let mut text = String::from(
        "bed,waves,fouling_cm,mixture,mixture_top_layer,tdsp_waveform,tdsp_envelope,tdsp_base_alone,srm_top_layer,crim_nominal_voids\n",
    );
    for row in rows {
        for reading in &row.readings {
            let srm = reading.reflection.map_or(String::new(), |eps| format!("{eps:.4}"));
            text.push_str(&format!(
                "{},{},{:.0},{:.4},{:.4},{:.4},{:.4},{:.4},{srm},{:.4}\n",
                row.bed,
                row.waves.name(),
                row.fouling_cm,
                reading.truth,
                reading.truth_above,
                reading.delay_waveform,
                reading.delay_envelope,
                reading.delay_base,
                reading.mixture
            ));
        }
    }
    text
}

/// What is drawn of a row.
type Method = fn(&BiasRow) -> Option<MeanAndSpread>;

/// Bias against fouling height: by the delay above, by the reflection below; each bed kind and polarisation one curve with its
/// standard deviation as dotted lines.
fn figure(rows: &[BiasRow]) -> Panels {
    let methods: [(&str, Method); 2] = [
        ("Delay between the envelopes of surface and base (TDSP)", |row| row.delay_envelope),
        ("Surface echo over that of a metal plate (SRM), top layer", |row| row.reflection),
    ];
    let charts = methods.map(|(title, of)| {
        let mut chart = Chart::new(title, Axis::linear("fouled height", "cm"), Axis::linear("bias", "%"));
        chart.lines.push(ReferenceLine::horizontal(0.0, ""));
        for (index, group) in rows.chunk_by(|a, b| a.bed == b.bed && a.waves == b.waves).enumerate() {
            let at = |sign: f64| {
                let points = group.iter().filter_map(|row| {
                    // Beside one another, so that the bars can be told apart.
                    let x = row.fouling_cm + 0.3 * (index as f64 - 2.0);
                    of(row).map(|found| (x, found.mean + sign * found.standard_deviation))
                });
                points.collect::<Vec<_>>()
            };
            let name = group.first().map_or(String::new(), |row| format!("{}, {}", row.bed, row.waves.name()));
            chart.series.push(Series::line(&name, at(0.0)).drawn(Stroke::LineAndPoints, index));
            let bars: Vec<(f64, f64)> =
                at(-1.0).into_iter().zip(at(1.0)).flat_map(|(low, high)| [low, high, (high.0, f64::NAN)]).collect();
            chart.series.push(Series { width: 1.0, ..Series::line("", bars).drawn(Stroke::Solid, index) });
        }
        chart
    });
    Panels {
        size: [960.0, 1040.0],
        ..Panels::stacked("Bias of the permittivity estimates, mean ± standard deviation", charts.into())
    }
}

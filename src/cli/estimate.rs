//! `estimate`: permittivity, thickness and fouling from the echoes of a trace.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::compare::{expected, read_window};
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::scene_args::SceneArgs;
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::permittivity::{from_surface_reflection, from_two_way_time};
use crate::compare::pulse::{Gate, PlateOptions, plate_echo};
use crate::compare::{self, Echo, EchoPick, ExpectedEchoes};
use crate::fdtd::Fdtd;
use crate::files;
use crate::forward::Progress;
use crate::plot::{Axis, Chart, Figure as _, Marker, Panels, ReferenceLine, Series, Stroke};
use crate::scene::{self, FoulingAmount, FoulingReport, FoulingSpec, PackingMethod, Scene, SceneSpec};
use crate::study::{DelayCurve, LengthEstimate, delay_curve};
use crate::trace::AScan;
use crate::units::constants::C0;
use crate::units::{Hertz, Metres, Seconds};

/// Estimate the permittivity of a layer, its thickness and its fouling from the echoes of a trace.
///
/// Side by side: from the delay between surface and base (TDSP), from the surface echo over that of a metal plate (SRM), and from
/// the composition of a scene (CRIM). With a scene, beds of many seeds are simulated at several fouling heights: the thickness
/// and the fouled height come with the uncertainty that the packing alone gives them. A section of stones (TMz) is slower than the
/// mixture: see `validate permittivity-bias`, and `--equivalent-2d`.
#[derive(Debug, Clone, Args)]
#[command(
    after_help = "Example:\n  ballast-gpr estimate track.dzt --thickness 48cm --plate plate.dzt --surface 5ns..7ns --base 11ns..14ns\n  ballast-gpr estimate tank-clean-seed-1 --scene tank-clean-seed-1"
)]
pub struct EstimateArgs {
    /// The trace: an instrument's file, a folder of `build` and `run`, gprMax's output, or two-column text.
    #[arg(value_name = "TRACE")]
    pub trace: PathBuf,
    /// Thickness from the surface to the base that echoes [default: that of the scene, base plate included].
    #[arg(long, value_name = "LENGTH")]
    pub thickness: Option<Metres>,
    /// Trace over a metal plate at the height of the surface, for SRM.
    #[arg(long, value_name = "TRACE")]
    pub plate: Option<PathBuf>,
    /// Trace of the antenna alone, taken off both.
    #[arg(long, value_name = "TRACE")]
    pub free_space: Option<PathBuf>,
    /// Composition: a folder written by `build`, or a scene file. The flags below change it.
    #[arg(long, value_name = "FOLDER|SCENE.toml")]
    pub scene: Option<PathBuf>,
    /// Where the surface's echo is looked for, as FROM..TO (5ns..7ns) [default: that of a built folder, else the first].
    #[arg(long, value_name = "FROM..TO", value_parser = read_window)]
    pub surface: Option<(Seconds, Seconds)>,
    /// Where the echo of the base is looked for [default: that of a built folder, else the strongest after the surface's].
    #[arg(long, value_name = "FROM..TO", value_parser = read_window)]
    pub base: Option<(Seconds, Seconds)>,
    /// Nominal frequency of the antenna, for the gate around the plate's echo.
    #[arg(long = "nominal", value_name = "FREQUENCY", default_value = "1GHz")]
    pub nominal: Hertz,
    /// Beds simulated at each fouling height, with a scene; 0 for none.
    #[arg(long, value_name = "NUM", default_value_t = 10)]
    pub seeds: u64,
    /// Write figure and numbers as STEM.png, STEM.svg and STEM.json.
    #[arg(long, value_name = "STEM", default_value = "estimate")]
    pub out: PathBuf,
    /// Draw no figure and write no files.
    #[arg(long)]
    pub no_figure: bool,
    /// Overwrite files that are there.
    #[arg(long)]
    pub force: bool,
    /// Print the numbers as JSON.
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub args: SceneArgs,
}

/// Estimates of one trace.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Estimates {
    /// Name of the trace.
    pub trace: String,
    /// The surface's echo.
    pub surface: Echo,
    /// The echo of the base.
    pub base: Echo,
    /// Thickness between them, where it is known.
    pub thickness: Option<Metres>,
    /// Permittivity from the delay of the waveforms' extrema.
    pub tdsp_waveform: Option<f64>,
    /// Permittivity from the delay of the envelopes' peaks.
    pub tdsp_envelope: Option<f64>,
    /// Amplitude of the surface's echo over that of the plate's.
    pub surface_over_plate: Option<f64>,
    /// Permittivity of the uppermost layer from that; none where it is no reflection.
    pub srm: Option<f64>,
    /// Why there is none.
    pub srm_failed: Option<String>,
    /// From the composition.
    pub composition: Option<Composition>,
}

/// What a scene says of its bed.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Composition {
    /// Permittivity of the layers from surface to base, as their delay has it, by the scene's mixing rule.
    pub column: f64,
    /// Of the uppermost layer.
    pub above: f64,
    /// Thickness from the measured delay (envelopes) and `column`.
    pub thickness: Metres,
    /// Fouled height that gives the measured delay with the permittivities of clean and fouled mixture.
    pub fouled_height: Option<Metres>,
}

/// What the simulated beds say.
#[derive(Debug, Clone, serde::Serialize)]
struct Ensemble {
    curve: DelayCurve,
    thickness_if_clean: Option<LengthEstimate>,
    fouled_height: Option<LengthEstimate>,
    /// Indices at the estimate less one standard deviation, at it, and with one more; cut off at the bed's ends.
    fouling: Vec<FoulingReport>,
}

/// Runs the subcommand.
///
/// # Errors
/// When a trace cannot be read, an echo not found, or a file not written.
pub fn run(args: &EstimateArgs) -> Result<(), CliError> {
    let beside = ["png", "svg", "json"].map(|ending| folder::with_ending(&args.out, ending));
    if !args.no_figure {
        for path in &beside {
            folder::may_write(path, args.force)?;
        }
    }
    let scene = match &args.scene {
        Some(path) => Some(scene::resolve(&args.args.spec(Some(path))?)?),
        None if args.args != SceneArgs::default() => {
            return Err(CliError::input(
                "a flag of a scene was given, but no scene\n\nhint: name one with `--scene FOLDER`",
            ));
        }
        None => None,
    };
    if let Some(thickness) = args.thickness.filter(|thickness| thickness.si() <= 0.0) {
        return Err(CliError::input(format!(
            "`--thickness` is {thickness}, but must be above 0 m\n\nhint: `--thickness 48cm`"
        )));
    }
    let (trace, estimates) = estimates(args, scene.as_ref())?;
    let ensemble = match &scene {
        Some(scene) if args.seeds > 0 => Some(ensemble(args, scene, &estimates)?),
        _ => None,
    };
    let value = serde_json::json!({
        "format_version": 1, "program": folder::program(), "estimates": estimates, "ensemble": ensemble,
    });
    let mut text = serde_json::to_string_pretty(&value)?;
    text.push('\n');
    if !args.no_figure {
        let parent = args.out.parent().unwrap_or(Path::new(""));
        files::create_folder(parent)?;
        let name = args.out.file_name().map_or("estimate".into(), |name| name.to_string_lossy().into_owned());
        figure(&trace, &estimates, ensemble.as_ref()).write(parent, &name)?;
        files::write_bytes(&beside[2], text.as_bytes())?;
        eprintln!("written: {0}.png, {0}.svg, {0}.json", args.out.display());
    }
    if args.json {
        print!("{text}");
    } else {
        table(&estimates).print();
        if let (Some(ensemble), Some(scene)) = (&ensemble, &scene) {
            println!();
            lengths(ensemble, &estimates, scene).print();
        }
    }
    Ok(())
}

fn estimates(args: &EstimateArgs, scene: Option<&Scene>) -> Result<(AScan, Estimates), CliError> {
    let free_space = args.free_space.as_deref().map(trace_file::read).transpose()?;
    let mut trace = trace_file::read(&args.trace)?;
    if let Some(reference) = &free_space {
        trace = compare::subtract_reference(&trace, reference).0;
    }
    let mut windows = expected(&[&args.trace])?;
    windows.surface = args.surface.or(windows.surface);
    windows.plate = args.base.or(windows.plate);
    windows.no_direct_wave = free_space.is_some();
    windows.no_noise |= args.surface.is_some() && args.base.is_some();
    let thickness =
        args.thickness.or_else(|| scene.map(|s| Metres(s.layers.iter().map(|layer| layer.thickness.si()).sum())));
    let plate = args.plate.as_deref().map(trace_file::read).transpose()?;
    let plate = plate
        .map(|plate| {
            let gate = Gate::of_frequency(args.nominal.si());
            // The plate lies where the surface does, so its echo is about there as well.
            let window = windows.surface.map(|(from, to)| {
                let half = 0.5 / args.nominal.si();
                (Seconds(from.si() - half), Seconds(to.si() + half))
            });
            plate_echo(&plate, free_space.as_ref(), &PlateOptions { gate, window }).map(|found| found.echo)
        })
        .transpose()?;
    let found = of_trace(&trace, &windows, thickness, plate.as_ref(), scene)?;
    Ok((trace, found))
}

/// Picks surface and base in a trace and reads the permittivities off them.
///
/// # Errors
/// When one of the echoes is not found.
pub fn of_trace(
    trace: &AScan,
    windows: &ExpectedEchoes,
    thickness: Option<Metres>,
    plate: Option<&Echo>,
    scene: Option<&Scene>,
) -> Result<Estimates, CliError> {
    let picks = compare::pick_echoes(trace, windows);
    let pick = |found: EchoPick, which: &str, flag: &str| match found {
        EchoPick::Picked(echo) => Ok(echo),
        EchoPick::NotPicked(reason) => Err(CliError::input(format!(
            "`{}` has no echo of the {which}: {reason}\n\nhint: say where it is, for example `{flag} 5ns..7ns`",
            trace.name
        ))),
    };
    let surface = pick(picks.surface, "surface", "--surface")?;
    let base = pick(picks.plate, "base", "--base")?;
    let delays =
        [base.waveform.time.si() - surface.waveform.time.si(), base.envelope.time.si() - surface.envelope.time.si()];
    if delays.iter().any(|delay| *delay <= 0.0) {
        return Err(CliError::input(format!(
            "in `{}` the base's echo ({}) does not come after the surface's ({})\n\nhint: say where they are with `--surface FROM..TO` and `--base FROM..TO`",
            trace.name, base.waveform.time, surface.waveform.time
        )));
    }
    let ratio = plate.map(|plate| surface.waveform.amplitude / plate.waveform.amplitude);
    let srm = plate.map(|plate| from_surface_reflection(surface.waveform.amplitude, plate.waveform.amplitude));
    let tdsp = |delay: f64| thickness.map(|thickness| from_two_way_time(Seconds(delay), thickness));
    Ok(Estimates {
        trace: trace.name.clone(),
        surface,
        base,
        thickness,
        tdsp_waveform: tdsp(delays[0]),
        tdsp_envelope: tdsp(delays[1]),
        surface_over_plate: ratio,
        srm: srm.as_ref().and_then(|found| found.as_ref().ok().copied()),
        srm_failed: srm.and_then(Result::err).map(|error| error.to_string()),
        composition: scene.map(|scene| composition(scene, delays[1])).transpose()?,
    })
}

/// The figures of a scene's mixtures for a delay, s.
fn composition(scene: &Scene, delay: f64) -> Result<Composition, CliError> {
    let optical = |scene: &Scene| scene.layers.iter().map(|l| l.thickness.si() * l.eps_r.sqrt()).sum::<f64>();
    let thickness: f64 = scene.layers.iter().map(|layer| layer.thickness.si()).sum();
    let column = (optical(scene) / thickness).powi(2);
    let height = scene.spec.tank.height;
    let [clean, fouled] = [Metres(0.0), height].map(|fouled| as_layers(&scene.spec, fouled));
    let (clean, fouled) = (optical(&clean?), optical(&fouled?));
    let share = (0.5 * C0 * delay - clean) / (fouled - clean);
    let inside = (fouled > clean && (0.0..=1.0).contains(&share)).then(|| Metres(share * height.si()));
    Ok(Composition {
        column,
        above: scene.layers.first().map_or(1.0, |layer| layer.eps_r),
        thickness: Metres(0.5 * C0 * delay / column.sqrt()),
        fouled_height: inside,
    })
}

/// A scene as layers, fouled to a height.
fn as_layers(spec: &SceneSpec, fouled: Metres) -> Result<Scene, CliError> {
    let mut spec = spec.clone();
    spec.packing.method = PackingMethod::Homogeneous;
    let amount = FoulingAmount::Height(fouled);
    spec.fouling = (fouled.si() > 0.0).then(|| match spec.fouling.take() {
        Some(fines) => FoulingSpec { amount, ..fines },
        None => FoulingSpec::of(amount),
    });
    Ok(scene::resolve(&spec)?)
}

fn ensemble(args: &EstimateArgs, scene: &Scene, estimates: &Estimates) -> Result<Ensemble, CliError> {
    let height = scene.spec.tank.height.si();
    let heights = [0.0, 0.2, 0.4, 0.6].map(|share| Metres(share * height));
    let bar = Bar::new("beds");
    let total = 4 * args.seeds as usize;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let on_progress = |progress: Progress| {
        if progress.done == progress.total {
            done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        }
        let now = done.load(std::sync::atomic::Ordering::Relaxed).min(total);
        let _ = bar.update(Progress { done: now, total });
        interrupt::flow()
    };
    let curve = delay_curve(&Fdtd::default(), &scene.spec, &heights, args.seeds, &on_progress)?;
    drop(bar);
    let delay = Seconds(estimates.base.envelope.time.si() - estimates.surface.envelope.time.si());
    let fouled_height = curve.height_of(delay);
    let mut fouling = vec![];
    if let Some(found) = &fouled_height {
        for deviations in [-1.0, 0.0, 1.0] {
            let at = found.value.si() + deviations * found.standard_deviation.si();
            // A trace of fouling in place of none, for which there are no indices.
            let layered = as_layers(&scene.spec, Metres(at.clamp(1e-6 * height, height)))?;
            fouling.extend(layered.fouling);
        }
    }
    Ok(Ensemble { thickness_if_clean: curve.thickness_if_clean(delay), fouled_height, fouling, curve })
}

/// The permittivities as a table.
pub fn table(of: &Estimates) -> Report {
    let mut table = Report::new(
        format!("Permittivity by `{}`", of.trace),
        ["method", "what it is of", "relative permittivity", "from"],
    );
    let number = |value: Option<f64>| value.map_or("–".into(), |value| format!("{value:.3}"));
    let thickness = of.thickness.map_or("no thickness given".into(), |t| format!("{} thick", t.in_unit("cm")));
    let time = |from: Seconds, to: Seconds| {
        format!("{:.3} ns after {:.3} ns, {thickness}", 1e9 * (to.si() - from.si()), 1e9 * from.si())
    };
    table.row([
        "TDSP, waveform".into(),
        "surface to base".into(),
        number(of.tdsp_waveform),
        time(of.surface.waveform.time, of.base.waveform.time),
    ]);
    table.row([
        "TDSP, envelope".into(),
        "surface to base".into(),
        number(of.tdsp_envelope),
        time(of.surface.envelope.time, of.base.envelope.time),
    ]);
    if let Some(ratio) = of.surface_over_plate {
        let why = if of.srm.is_some() { "" } else { ": no reflection" };
        table.row([
            "SRM".into(),
            "uppermost layer".into(),
            number(of.srm),
            format!("surface echo {ratio:.3} of the plate's{why}"),
        ]);
    }
    if let Some(composition) = &of.composition {
        table.row([
            "CRIM".into(),
            "surface to base".into(),
            number(Some(composition.column)),
            "composition of the scene".into(),
        ]);
        table.row([
            "CRIM".into(),
            "uppermost layer".into(),
            number(Some(composition.above)),
            "composition of the scene".into(),
        ]);
    }
    table
}

fn lengths(ensemble: &Ensemble, of: &Estimates, scene: &Scene) -> Report {
    let seeds = ensemble.curve.points.iter().map(|point| point.delays.len()).max().unwrap_or(0);
    let mut table = Report::new(
        format!("Lengths from the delay, ± one standard deviation of {seeds} beds at each of four fouling heights"),
        ["", "simulated beds", "mixtures"],
    );
    let centimetres = |length: &Option<LengthEstimate>| {
        length.map_or("–".into(), |l| {
            format!("{:.1} ± {:.1} cm", 100.0 * l.value.si(), 100.0 * l.standard_deviation.si())
        })
    };
    let composition = of.composition.as_ref();
    let nominal = scene.spec.tank.height.in_unit("cm");
    table.row([
        "thickness of the bed, if it is clean".into(),
        centimetres(&ensemble.thickness_if_clean),
        composition.map_or("–".into(), |c| format!("{:.1} cm with the base plate", 100.0 * c.thickness.si())),
    ]);
    table.row([
        format!("fouled height, if the bed is {nominal} thick"),
        centimetres(&ensemble.fouled_height),
        composition
            .and_then(|c| c.fouled_height)
            .map_or("beyond the bed".into(), |h| format!("{:.1} cm", 100.0 * h.si())),
    ]);
    if let [low, middle, high] = ensemble.fouling.as_slice() {
        let span = |of: fn(&FoulingReport) -> String| {
            let (low, middle, high) = (of(low), of(middle), of(high));
            if low == high { middle } else { format!("{middle} ({low} to {high})") }
        };
        let mut add = |name: &str, value: String| table.row([name.into(), value, String::new()]);
        add("Selig's fouling index, %", span(|f| f.nominal.selig.map_or("–".into(), |i| format!("{i:.1}"))));
        add("its class", span(|f| f.nominal.selig_class.map_or("–".into(), |class| class.name().into())));
        add("voids filled, %", span(|f| format!("{:.0}", f.nominal.percentage_void_contamination)));
        add("relative ballast fouling ratio, %", span(|f| format!("{:.1}", f.nominal.relative_ballast_fouling_ratio)));
        add("its class", span(|f| f.nominal.relative_class.name().into()));
    }
    table
}

/// The trace with its picks, and the delays of the simulated beds with that of the trace.
fn figure(trace: &AScan, of: &Estimates, ensemble: Option<&Ensemble>) -> Panels {
    let mut charts = vec![picks_chart(trace, of)];
    if let Some(ensemble) = ensemble {
        let mut chart =
            Chart::new("Delay from surface to base", Axis::linear("fouled height", "cm"), Axis::linear("delay", "ns"));
        let points = |point: &crate::study::DelayPoint| {
            let height = 100.0 * point.height.si();
            point.delays.iter().map(move |delay| (height, 1e9 * delay)).collect::<Vec<_>>()
        };
        let all = ensemble.curve.points.iter().flat_map(points).collect();
        chart.series.push(Series::line("simulated beds", all).drawn(Stroke::Points, 0));
        let delay = 1e9 * (of.base.envelope.time.si() - of.surface.envelope.time.si());
        chart.lines.push(ReferenceLine::horizontal(delay, "the trace"));
        if let Some(height) = &ensemble.fouled_height {
            let label = format!("{:.1} ± {:.1} cm", 100.0 * height.value.si(), 100.0 * height.standard_deviation.si());
            chart.lines.push(ReferenceLine::vertical(100.0 * height.value.si(), &label));
        }
        charts.push(chart);
    }
    Panels::stacked(&format!("Echoes of {}", of.trace), charts)
}

/// A trace, its envelope and the picks.
pub fn picks_chart(trace: &AScan, of: &Estimates) -> Chart {
    let curve = |trace: &AScan| trace.times().zip(&trace.samples).map(|(t, v)| (1e9 * t, *v)).collect::<Vec<_>>();
    let envelope = compare::envelope(trace);
    let mut chart = Chart::new("Trace and picks", Axis::linear("time", "ns"), Axis::linear("amplitude", ""))
        .with(Series::line("trace", curve(trace)))
        .with(Series::line("envelope", curve(&envelope)).drawn(Stroke::Dashed, 1));
    for (name, echo) in [("surface", &of.surface), ("base", &of.base)] {
        for (pick, colour) in [(&echo.waveform, 0), (&echo.envelope, 1)] {
            chart.markers.push(Marker { x: 1e9 * pick.time.si(), y: pick.amplitude, label: name.into(), colour });
        }
    }
    chart
}

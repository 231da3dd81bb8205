//! `demo`: the whole way in one command, without gprMax and without a file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;

use crate::cli::build::build_folder;
use crate::cli::comparison_figure;
use crate::cli::error::CliError;
use crate::cli::folder;
use crate::cli::interrupt;
use crate::cli::progress::Bar;
use crate::cli::run::{SolverName, plain_run, run_one};
use crate::cli::table::Report;
use crate::cli::trace_file;
use crate::compare::{self, CompareOptions, ExpectedEchoes, Polarity};
use crate::fdtd::Fdtd;
use crate::files;
use crate::forward::Progress;
use crate::plot::Figure as _;
use crate::scene::{EquivalentStone, FoulingSpec, PackingMethod, Scene, SceneSpec, resolve};
use crate::study::{EchoTime, Echoes, PlateReference, plate_reference, simulate_echoes};
use crate::units::Seconds;

/// Clean and fouled tank: built, simulated, read back, compared and drawn, with one line against an exact answer.
#[derive(Debug, Clone, Args)]
pub struct DemoArgs {
    /// Folder to write.
    #[arg(long, value_name = "FOLDER", default_value = "demo")]
    pub out: PathBuf,
    /// Write into a folder that is not empty, over files of the same names.
    #[arg(long)]
    pub force: bool,
    /// Print the fouled scene as TOML, to start your own from, and end.
    #[arg(long)]
    pub print_scene: bool,
    /// Also run real gprMax on both tanks and compare (a minute or two; see `gprmax install`).
    #[arg(long)]
    pub with_gprmax: bool,
    /// Print the table as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the subcommand.
///
/// # Errors
/// When a step fails.
pub fn run(args: &DemoArgs) -> Result<(), CliError> {
    let clean = SceneSpec { title: "Clean tank".into(), ..SceneSpec::preset("tank")? };
    let fouled = SceneSpec {
        title: "Tank with 20 cm of fouling".into(),
        fouling: Some(FoulingSpec::of("20cm".parse()?)),
        ..clean.clone()
    };
    if args.print_scene {
        print!("{}", resolve(&fouled)?.spec.to_toml()?);
        return Ok(());
    }
    let started = Instant::now();
    folder::prepare(&args.out, args.force)?;
    let bar = Bar::new("demo");
    let step = |done| bar.update(Progress { done, total: 9 });
    let folders = [("clean", &clean), ("fouled-20cm", &fouled)].map(|(name, spec)| (args.out.join(name), spec));
    for (target, spec) in &folders {
        build_folder(spec, target, None, args.force)?;
        run_one(&plain_run(target, SolverName::Fdtd, args.force), target)?;
    }
    let _ = step(3);
    if args.with_gprmax {
        for (target, _) in &folders {
            run_one(&plain_run(target, SolverName::Gprmax, args.force), target)?;
        }
    }
    let traces = [trace_file::read(&folders[0].0)?, trace_file::read(&folders[1].0)?];
    let solver = Fdtd::default();
    let on_progress = |_| interrupt::flow();
    let scene = resolve(&clean)?;
    let reference = plate_reference(&solver, &scene, &on_progress)?;
    let _ = step(5);
    write_comparison(&args.out, &traces, &reference, [&scene, &resolve(&fouled)?])?;

    let mut table = Report::new(
        "Echoes from the emission, ns (by the waveform; one packing each, `validate tank-echoes` has ten)",
        ["bed", "surface", "plate", "plate, layers", "plate late by"],
    );
    let mut row = |name: &str, echoes: &Echoes, scene: &Scene| {
        let plate = |time: &EchoTime| 1e9 * time.waveform.si();
        let layers = 1e9 * scene.arrivals.plate.si();
        table.row([
            name.into(),
            format!("{:.3}", plate(&echoes.surface)),
            format!("{:.3}", plate(&echoes.plate)),
            format!("{layers:.3}"),
            format!("{:+.3}", plate(&echoes.plate) - layers),
        ]);
    };
    let mut exact = None;
    for (spec, name, trace) in [(&clean, "clean", &traces[0]), (&fouled, "20 cm of fouling", &traces[1])] {
        let layered = SceneSpec {
            packing: crate::scene::PackingSpec { method: PackingMethod::Homogeneous, ..spec.packing.clone() },
            ..spec.clone()
        };
        let layered = resolve(&layered)?;
        let (_, echoes) = simulate_echoes(&solver, &layered, &reference, &on_progress)?;
        row(&format!("{name}, homogeneous layers"), &echoes, &layered);
        exact.get_or_insert((layered.arrivals.plate, echoes.plate.waveform));
        let scene = resolve(spec)?;
        row(&format!("{name}, stones"), &reference.echoes(&scene, trace)?, &scene);
        let mut equivalent = spec.clone();
        equivalent.packing.stone_permittivity = EquivalentStone::Equivalent2d;
        let equivalent = resolve(&equivalent)?;
        let (_, echoes) = simulate_echoes(&solver, &equivalent, &reference, &on_progress)?;
        row(&format!("{name}, stones with the 2-D equivalent permittivity"), &echoes, &equivalent);
        let _ = step(7);
    }
    drop(bar);
    if args.json {
        println!("{}", serde_json::to_string_pretty(&table.json())?);
        return Ok(());
    }
    table.print();
    if let Some((exact, ours)) = exact {
        println!("\n{}", exact_line(exact, ours));
    }
    if args.with_gprmax {
        for (target, _) in &folders {
            if let Some([fdtd, gprmax]) = trace_file::both_results(target) {
                let (ours, theirs) = (trace_file::read(&fdtd)?, trace_file::read(&gprmax)?);
                println!(
                    "{}: built-in solver against gprMax, relative L2 difference {:.1e}",
                    target.display(),
                    compare::relative_l2(&theirs, &ours)?
                );
            }
        }
    }
    println!("\nfigure: {}", args.out.join("demo.png").display());
    println!("maps, packings, gprMax inputs: {} and {}", folders[0].0.display(), folders[1].0.display());
    println!("done in {:.1} s", started.elapsed().as_secs_f64());
    Ok(())
}

fn exact_line(exact: Seconds, ours: Seconds) -> String {
    format!(
        "plate echo under homogeneous clean ballast: {:.3} ns, exact {:.3} ns, {:+.2} %",
        1e9 * ours.si(),
        1e9 * exact.si(),
        100.0 * (ours.si() / exact.si() - 1.0)
    )
}

fn write_comparison(
    folder: &Path,
    [clean, fouled]: &[crate::trace::AScan; 2],
    reference: &PlateReference,
    scenes: [&Scene; 2],
) -> Result<(), CliError> {
    let windows = scenes.map(|scene| reference.windows(scene));
    let join = |a: (Seconds, Seconds), b: (Seconds, Seconds)| {
        (Seconds(a.0.si().min(b.0.si())), Seconds(a.1.si().max(b.1.si())))
    };
    let options = CompareOptions {
        reference_a: Some(reference.free_space.clone()),
        reference_b: Some(reference.free_space.clone()),
        expected: ExpectedEchoes {
            surface: Some(join(windows[0].0, windows[1].0)),
            plate: Some(join(windows[0].1, windows[1].1)),
            no_direct_wave: true,
            no_noise: true,
            ..ExpectedEchoes::default()
        },
        polarity: Polarity::Keep,
        ..CompareOptions::default()
    };
    let mut comparison = compare::compare(clean, fouled, &options)?;
    comparison.a.name = "clean".into();
    comparison.b.name = "20 cm of fouling".into();
    comparison_figure::figure(
        "Tank of Benedetto et al. 2018, simulated at 1 GHz, direct wave taken off",
        &comparison,
        false,
    )
    .write(folder, "demo")?;
    let mut text = serde_json::to_string_pretty(&comparison)?;
    text.push('\n');
    files::write_bytes(&folder.join("demo.json"), text.as_bytes())?;
    Ok(())
}

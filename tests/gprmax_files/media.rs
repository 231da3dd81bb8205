//! Reading and writing what fills the cells and what bounds the grid.

use std::path::Path;

use ballast_gpr::gprmax::{InputOptions, read_model, write_input};
use ballast_gpr::model::{AbsorbingProfile, Axis, Formulation, Grading, Model, Resonance, Stretch};

fn read(text: &str) -> Result<Model, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.in");
    std::fs::write(&path, text).unwrap();
    let shown = format!("`{}`", path.display());
    read_model(&path).map_err(|error| error.to_string().replace(&shown, "FILE"))
}

/// The scenes that gprMax has run say the same after reading, writing and reading again, to the bit.
#[test]
fn scenes_survive_a_round_trip() {
    let mut seen = 0;
    for folder in ["gprmax", "gprmax3d"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation").join(folder);
        for entry in std::fs::read_dir(folder).unwrap() {
            let scene = entry.unwrap().path().join("scene.in");
            let text = std::fs::read_to_string(&scene).unwrap_or_default();
            // A block of voxels is written to files of its own, and a source that starts late is given an end.
            if text.is_empty() || text.contains("#geometry_objects_read") {
                continue;
            }
            let model = read_model(&scene).unwrap();
            let place = tempfile::tempdir().unwrap();
            let written = write_input(&model, place.path(), "again", &InputOptions::default()).unwrap();
            assert_eq!(read_model(&written[0]).unwrap(), model, "{}", scene.display());
            seen += 1;
        }
    }
    assert!(seen >= 40, "{seen}");
}

/// gprMax 4.0.1 gives `#domain: inf 0.09 0.06` with `TE` 2 x 30 x 30 cells and a step over two axes, and needs the source
/// at node 1; with `TM` it gives one cell.
#[test]
fn modes_make_the_infinite_axis_two_cells_or_one() {
    let text = |mode: &str| {
        format!(
            "#domain: inf 0.09 0.06\n#domain_mode: {mode}\n#dx_dy_dz: 0.002 0.003 0.002\n#time_window: 60\n\
             #pml_cells: 0 5 5 0 5 5\n"
        )
    };
    let model = read(&text("te")).unwrap();
    assert_eq!((model.grid.cells, model.transverse_electric), ([2, 30, 30], Some(Axis::X)));
    assert_eq!(model.time_step(), 5.550842071803178e-12);
    let model = read(&text("TM")).unwrap();
    assert_eq!((model.grid.cells, model.transverse_electric), ([1, 30, 30], None));
    assert_eq!(model.time_step(), 5.550842071803178e-12);
}

#[test]
fn modes_and_grids_that_do_not_fit_are_refused() {
    let error = |domain: &str, mode: &str, more: &str| {
        let head = "#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 60\n#waveform: ricker 1 1e9 w\n";
        read(&format!("#domain: {domain}\n{mode}\n{head}{more}\n")).unwrap_err()
    };
    assert_eq!(
        error("0.1 0.1 0.004", "#domain_mode: TE", ""),
        "FILE line 1: `#domain` has 0 infinite axes, but `#domain_mode: TM` and `TE` want one\n\n\
         hint: write `inf` for the axis along which nothing changes, for example `#domain: 0.6 0.5 inf`"
    );
    assert_eq!(
        error("0.1 0.1 inf", "", ""),
        "FILE line 1: `inf` in `#domain` wants a two-dimensional mode\n\n\
         hint: add `#domain_mode: TM` or `#domain_mode: TE`"
    );
    assert_eq!(
        error("0.1 0.1 inf", "#domain_mode: TEM", ""),
        "FILE line 2: `TEM` is not a mode, which `#domain_mode` wants there: one of TM, TE, 3D"
    );
    assert!(error("0.1 0.002 inf", "#domain_mode: TE", "").contains("more than one axis of a single cell"));
    assert!(error("0.1 0.1 inf", "#domain_mode: TE", "#pml_cells: 5").contains("5 + 5 absorbing cells do not fit"));
    assert_eq!(
        error("0.1 0.1 inf", "#domain_mode: TE", "#hertzian_dipole: z 0.05 0.05 0.002 w"),
        "FILE line 6: a source along z in a TE model across z: it must point along one of the other axes"
    );
    assert_eq!(
        error("0.1 0.1 inf", "#domain_mode: TE", "#hertzian_dipole: x 0.05 0.05 0 w"),
        "FILE line 6: a source at node 0 along z of a TE model, whose fields are at node 1\n\n\
         hint: give 0.002 for its z coordinate"
    );
}

/// gprMax takes Debye commands first, then Lorentz, then Drude, and the last replaces the poles that a material had.
#[test]
fn poles_are_read_and_replaced() {
    let head = "#domain: 0.1 0.1 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 60\n#material: 3 0 1 0 sand\n";
    let model = read(&format!(
        "{head}#add_dispersion_drude: 2 1e9 2e9 3e9 4e9 sand\n#add_dispersion_lorentz: 1 2 4e9 1e9 sand free_space\n\
         #add_dispersion_debye: 1 3 1e-11 sand\n"
    ))
    .unwrap();
    let drude = |frequency, collisions| Resonance::Drude { frequency, collisions };
    assert_eq!(model.materials[2].resonances, [drude(1e9, 2e9), drude(3e9, 4e9)]);
    assert!(model.materials[2].poles.is_empty() && !model.materials[2].averagable);
    let lorentz = Resonance::Lorentz { delta_eps: 2.0, frequency: 4e9, damping: 1e9 };
    assert_eq!(model.materials[1].resonances, [lorentz]);
    let error = |line: &str| read(&format!("{head}{line}\n")).unwrap_err();
    assert_eq!(
        error("#add_dispersion_lorentz: 1 2 1e9 7e9 sand"),
        "FILE line 5: the damping of `#add_dispersion_lorentz` is 7000000000, it should be below 2 pi times the frequency"
    );
    assert_eq!(
        error("#add_dispersion_drude: 2 1e9 1e9 sand"),
        "FILE line 5: `#add_dispersion_drude` has 4 parameters\n\n\
         hint: `#add_dispersion_drude: POLES FREQUENCY COLLISIONS [FREQUENCY COLLISIONS ...] ID [ID ...]`"
    );
    assert_eq!(
        error("#add_dispersion_drude: 1 1e9 0 sand"),
        "FILE line 5: the collision rate of `#add_dispersion_drude` is 0, it should be above 0"
    );
    assert!(error("#add_dispersion_lorentz: 1 2 4e9 1e9 pec").contains("a perfect conductor with dispersion"));
}

#[test]
fn profiles_of_the_boundary_are_read() {
    let head = "#domain: 0.1 0.1 0.002\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 60\n";
    let cfs = "#pml_cfs: constant forward 0 0.05 linear reverse 1 3 quartic forward 0 None\n";
    let model = read(&format!("{head}#pml_formulation: mripml\n{cfs}")).unwrap();
    let grading = |order, reverse, min, max| Grading { order, reverse, min, max };
    let stretch = Stretch {
        alpha: grading(0, false, 0.0, Some(0.05)),
        kappa: grading(1, true, 1.0, Some(3.0)),
        sigma: grading(4, false, 0.0, None),
    };
    assert_eq!(
        model.absorbing_profile,
        AbsorbingProfile { formulation: Formulation::Multipole, stretches: vec![stretch] }
    );
    let error = |text: &str| read(&format!("{head}{text}\n")).unwrap_err();
    assert!(error(&cfs.repeat(3)).contains("the third of `#pml_cfs` is not supported"));
    assert_eq!(
        error("#pml_cfs: foo forward 0 0 constant forward 1 1 quartic forward 0 None"),
        "FILE line 4: `foo` is not a profile, which `#pml_cfs` wants there: one of constant, linear, quadratic, cubic, \
         quartic, quintic, sextic, septic, octic"
    );
    assert!(
        error("#pml_cfs: linear up 0 0 constant forward 1 1 quartic forward 0 None")
            .contains("`up` is not a direction")
    );
    assert!(
        error("#pml_cfs: linear forward 0 None constant forward 1 1 quartic forward 0 None").contains("not a number")
    );
    assert!(error("#pml_formulation: CPML").contains("one of HORIPML, MRIPML"));
    assert!(error("#pml_slab: x0 5").contains("is not supported by the embedded solver"));
}

/// What stands in a file of boxes of noise that cannot be. gprMax 4.0.1 was seen to refuse all of these but a missing seed
/// (its noise is then another in each run), several materials of one that is no mixture (it fails on an index), and soil
/// whose conductivity is negative (it stops at its time step).
#[test]
fn boxes_of_noise_that_cannot_be_are_refused_by_line() {
    let head = "#domain: 0.04 0.04 0.04\n#dx_dy_dz: 0.002 0.002 0.002\n#time_window: 60\n#pml_cells: 0\n\
                #material: 4 0 1 0 sand\n#soil_peplinski: 0.5 0.5 2.0 2.66 0.001 0.25 soil\n#material_list: sand free_space two\n";
    let fractal = "#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 20 soil ground 7\n";
    let rough = "#add_surface_roughness: 0 0 0.02 0.04 0.04 0.02 1.5 1 1 0.014 0.03 ground 5\n";
    for (text, line, said) in [
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 20 soil ground", 8, "without a seed"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 20 soil ground -7", 8, "`-7` is not a number"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 20 soil ground y", 8, "`y` is not a number"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 -1 1 1 1 20 soil ground 7", 8, "the dimension"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 -1 1 20 soil ground 7", 8, "a weight"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 0 soil ground 7", 8, "the number of materials"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 1 soil ground 7", 8, "one material of a mixture"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 3 two ground 7", 8, "at most those of the list"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 3 sand ground 7", 8, "several materials out of one"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 1 sand ground 7", 8, "write `#box`"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.02 1.5 1 1 1 20 sail ground 7", 8, "did you mean `soil`"),
        ("#fractal_box: 0 0 0 0.04 0.04 0 1.5 1 1 1 20 soil ground 7", 8, "fills no cell along z"),
        ("#fractal_box: 0 0 0 0.04 0.04 0.06 1.5 1 1 1 20 soil ground 7", 8, "outside the domain"),
        (&format!("{fractal}{fractal}"), 9, "the fractal box `ground` is defined already"),
        (&format!("{fractal}{}", rough.replace("ground", "grind")), 9, "did you mean `ground`"),
        (&format!("{fractal}{}", rough.replace(" 5\n", "\n")), 9, "without a seed"),
        (&format!("{fractal}{rough}{rough}"), 10, "a second rough face"),
        (&format!("{fractal}{}", rough.replace("0.014", "-0.014")), 9, "the least coordinate"),
        (&format!("{fractal}{}", rough.replace("0.03 ", "0.05 ")), 9, "the largest coordinate"),
        (
            &format!("{fractal}{}", rough.replace("0 0 0.02 0.04 0.04 0.02", "0 0 0.01 0.04 0.04 0.01")),
            9,
            "an outer face",
        ),
        (&format!("{fractal}#add_surface_water: 0 0 0.02 0.04 0.04 0.02 0.02 ground"), 9, "not rough"),
        (&format!("{fractal}{rough}#add_surface_water: 0 0 0.02 0.04 0.04 0.02 0.032 ground"), 10, "the level"),
        ("#soil_peplinski: 1.1 0 1.6 2.66 0.1 0.2 dry", 8, "the share of sand"),
        ("#soil_peplinski: 0.5 0.2 1.6 2.66 0.3 0.2 dry", 8, "the most water"),
        ("#soil_peplinski: 0.5 0.2 1.6 0 0.1 0.2 dry", 8, "the density of sand"),
        ("#soil_peplinski: 0.5 0.2 1.6 2.66 0.1 0.2 soil", 8, "is defined already"),
        (
            "#soil_peplinski: 1 0 1.6 2.66 0.1 0.2 s\n#fractal_box: 0 0 0 0.04 0.04 0.02 1 1 1 1 9 s g 7",
            9,
            "conductivity",
        ),
        ("#material_range: 9 3 0 0.1 1 1 0 0 ores", 8, "at least its least value"),
        ("#material_range: 0.5 3 0 0.1 1 1 0 0 ores", 8, "the relative permittivity"),
        ("#material_list: sand stone all", 8, "the material `stone` is not defined"),
    ] {
        let message = read(&format!("{head}{text}")).map(|_| ()).unwrap_err();
        assert!(message.starts_with(&format!("FILE line {line}: ")) && message.contains(said), "{text}: {message}");
    }
    let model = read(&format!("{head}{fractal}{rough}")).unwrap();
    // The 20 soils of gprMax 4.0.1's material table for these parameters begin with this one.
    let first = &model.materials[3];
    assert_eq!(model.materials.len(), 23);
    assert!(
        (first.eps_r - 3.860_243_163_900_857_4).abs() < 1e-12
            && (first.sigma - 0.015_214_265_246_689_996).abs() < 1e-12,
        "{first:?}"
    );
}

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

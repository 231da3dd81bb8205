//! Scenes: what the user writes, what it resolves to, and what is refused.

use std::path::Path;

use ballast_gpr::model::{Object, paint};
use ballast_gpr::raster::build_model;
use ballast_gpr::scene::{FoulingSpec, PackingMethod, SceneSpec, Smoothing, resolve};
use ballast_gpr::units::{Metres, Share};

fn tank() -> SceneSpec {
    SceneSpec::preset("tank").unwrap()
}

fn fouled(amount: &str) -> SceneSpec {
    SceneSpec { fouling: Some(FoulingSpec::of(amount.parse().unwrap())), ..tank() }
}

fn refused(toml: &str) -> String {
    match SceneSpec::from_toml(toml, Path::new("mine.toml")) {
        Err(error) => error.to_string(),
        Ok(spec) => resolve(&spec).unwrap_err().to_string(),
    }
}

/// The resolved scene reads back as itself, and resolves to the same stones.
#[test]
fn a_resolved_scene_makes_itself_again() {
    let first = resolve(&fouled("20cm")).unwrap();
    let text = first.spec.to_toml().unwrap();
    assert!(text.contains("# assumed"), "{text}");
    let again = resolve(&SceneSpec::from_toml(&text, Path::new("scene.toml")).unwrap()).unwrap();
    assert_eq!(again.spec, first.spec);
    assert_eq!(again.discs(), first.discs());
    assert_eq!(again.spec.to_toml().unwrap(), text);
}

/// Layers and arrivals of the tank against `validation/tank` (independent computation), to the digits printed there.
#[test]
fn the_tank_has_the_published_arrivals() {
    let clean = resolve(&SceneSpec { packing: homogeneous(), ..tank() }).unwrap();
    assert!((clean.layers[0].eps_r - 3.6051).abs() < 5e-5);
    assert!((clean.arrivals.plate.si() * 1e9 - 9.2823).abs() < 5e-5);
    let spec = SceneSpec { packing: homogeneous(), ..fouled("20cm") };
    let fouled = resolve(&spec).unwrap();
    assert!((fouled.layers[1].eps_r - 5.8597).abs() < 5e-5);
    assert!((fouled.arrivals.plate.si() * 1e9 - 9.9787).abs() < 5e-5);
}

fn homogeneous() -> ballast_gpr::scene::PackingSpec {
    ballast_gpr::scene::PackingSpec { method: PackingMethod::Homogeneous, ..Default::default() }
}

/// 8, 16 and 24 % of the column of bed and base are 10, 20 and 30 cm (Benedetto 2017, Table 4; 0.08 is 0.0808 rounded).
#[test]
fn the_published_volume_shares_are_the_published_heights() {
    for (share, height) in [("8% by volume", 0.10), ("16% by volume", 0.20), ("24% by volume", 0.30)] {
        let scene = resolve(&SceneSpec { packing: homogeneous(), ..fouled(share) }).unwrap();
        assert!((scene.bed.fouled_height / height - 1.0).abs() < 0.015, "{share}: {}", scene.bed.fouled_height);
    }
    let half = resolve(&SceneSpec { packing: homogeneous(), ..fouled("50% of voids") }).unwrap();
    assert!((half.bed.fouled_height - 0.24).abs() < 1e-12);
}

/// Fouling of no height is no fouling: the same cells, material for material.
#[test]
fn fouling_of_zero_is_absent() {
    let without = build_model(&resolve(&tank()).unwrap()).unwrap();
    let with = build_model(&resolve(&fouled("0cm")).unwrap()).unwrap();
    assert_eq!(without, with);
}

/// Fouling that is there changes the cells of the voids below its height and no others.
#[test]
fn fouling_fills_the_voids_below_its_height() {
    let spec = |fouling| SceneSpec { fouling, ..tank() };
    let count = |spec: &SceneSpec| {
        let model = build_model(&resolve(spec).unwrap()).unwrap();
        let silt = model.material_named("silt");
        let painted = paint(&model).unwrap();
        painted.solid.iter().filter(|id| Some(**id) == silt).count() as f64 * 4e-6
    };
    assert_eq!(count(&spec(None)), 0.0);
    let found = count(&spec(Some(FoulingSpec::of("20cm".parse().unwrap()))));
    // The bottom 20 cm are denser than the bed as a whole: 30 to 44 % voids of 1.47 m x 0.20 m.
    assert!((0.30..0.44).contains(&(found / (1.47 * 0.20))), "{found}");
}

/// Area smoothing keeps the solid area that a staircase only approximates: the mean of eps over the bed's cells.
#[test]
fn area_smoothing_keeps_the_stones_area() {
    let mut spec = tank();
    spec.grid.cell = Metres(0.008);
    let scene = resolve(&SceneSpec { ..spec.clone() }).unwrap();
    let exact: f64 = scene.discs().iter().map(|disc| disc.area()).sum();
    let area_of = |smoothing| {
        let mut spec = spec.clone();
        spec.grid.smoothing = smoothing;
        let model = build_model(&resolve(&spec).unwrap()).unwrap();
        let Some(Object::Voxels(voxels)) = model.objects.iter().find(|object| matches!(object, Object::Voxels(_)))
        else {
            panic!("no voxels")
        };
        let sum: f64 = voxels.cells.iter().flatten().map(|id| (model.materials[id.index()].eps_r - 1.0) / 5.5).sum();
        sum * 0.008 * 0.008
    };
    // Rounding to 1/32 of a cell, random over some 6000 rim cells: 6000^0.5 * 64e-6 / 32 / 12^0.5 = 4e-5 m2 of 0.41 m2.
    assert!((area_of(Smoothing::Area) / exact - 1.0).abs() < 3e-4, "{}", area_of(Smoothing::Area) / exact);
    assert!((area_of(Smoothing::None) / exact - 1.0).abs() < 2e-2);
}

/// The equivalent stone makes the 2-D bulk equal to the mixture, at unchanged geometry.
#[test]
fn the_equivalent_stone_brings_the_bulk_to_the_mixture() {
    let mut spec = fouled("20cm");
    spec.packing.method = PackingMethod::Homogeneous;
    let honest = resolve(&spec).unwrap();
    assert!(honest.bulk[0].two_dimensional / honest.bulk[0].mixture > 1.15);
    spec.packing.stone_permittivity = ballast_gpr::scene::EquivalentStone::Equivalent2d;
    for zone in resolve(&spec).unwrap().bulk {
        assert!((zone.two_dimensional_in_model / zone.mixture - 1.0).abs() < 1e-9, "{zone:?}");
    }
}

/// Water in the fines makes them slower and lossy; none added is the dry fines bit by bit.
#[test]
fn moisture_matters_and_zero_moisture_is_absent() {
    let dry = resolve(&fouled("20cm")).unwrap();
    let mut spec = fouled("20cm");
    spec.moisture = Some(Default::default());
    assert_eq!(resolve(&spec).unwrap().bed, dry.bed);
    spec.moisture = Some(ballast_gpr::scene::MoistureSpec { fines: Share(0.10), voids: Share(0.0) });
    let wet = resolve(&spec).unwrap();
    // CRIM with water in the place of air: (sqrt 5.03 + 0.1 (sqrt 80 - 1))^2 = 9.25; the fit is good to a percent.
    let eps = wet.bed.void_fouled.eps_r_at(spec.antenna.frequency);
    assert!((eps / 9.25 - 1.0).abs() < 0.02, "{eps}");
    assert!(!wet.bed.void_fouled.dielectric.poles.is_empty());
}

#[test]
fn bad_scenes_are_refused_word_for_word() {
    let cases = [
        (
            "[packing]\nvoids = \"0%\"",
            "voids of 0% leave no space between the stones\n\nhint: the tank of Benedetto et al. 2018 had 42%",
        ),
        (
            "[packing]\nvoids = \"100%\"",
            "voids of 100% leave no stones\n\nhint: the tank of Benedetto et al. 2018 had 42%",
        ),
        (
            "[fouling]\namount = \"60cm\"",
            "fouling 60 cm high is more than the bed takes: with all voids full it is 48 cm high\n\nhint: ask for 48 cm high or less",
        ),
        (
            "[packing]\nvoid = \"42%\"",
            "the scene `mine.toml` cannot be read\n  line 2: void = \"42%\"\n  unknown field `void`, expected one of `method`, \
             `voids`, `grading`, `class_reading`, `input`, `strip`, `solid_share`, `dem`, `slice`, `file`, `stone`, `stone_permittivity`, `judged_by`, `mixing`\n\n\
             hint: did you mean `voids` in place of `void`?",
        ),
        (
            "[grid]\ncell = \"2\"",
            "the scene `mine.toml` cannot be read\n  line 2: cell = \"2\"\n  `2` has no unit: a length needs one of m, cm, mm, um, µm, \
             km\n\nhint: write for example `20cm`",
        ),
        (
            "[grid]\ncell = \"2 parsec\"",
            "the scene `mine.toml` cannot be read\n  line 2: cell = \"2 parsec\"\n  `2 parsec` has the unknown unit `parsec`: a length \
             needs one of m, cm, mm, um, µm, km\n\nhint: write for example `20cm`",
        ),
        (
            "[grid]\ncell = \"20cm\"",
            "`grid.cell` is 200 mm, but must be at most a tenth of the tank (48 mm)\n\nhint: `--cell 2mm`",
        ),
        (
            "[tank]\nwidth = \"-1 m\"",
            "`tank.width` is -1 m, but must be above 0 m\n\nhint: `width = \"1.47 m\"` under `[tank]`",
        ),
        (
            "[packing]\nstone = \"steel\"",
            "the material `steel` is a perfect conductor and cannot be part of the bed or the walls",
        ),
    ];
    for (toml, expected) in cases {
        assert_eq!(refused(toml), expected, "for:\n{toml}");
    }
}

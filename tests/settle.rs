//! Beds that settled: how dense they are, how many neighbours stones have, and that a stop changes nothing.

use std::cell::Cell;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

use ballast_gpr::packing::settle::{STATE, SettleError, SettleInput, SettleSpec, settle};
use ballast_gpr::packing::{ClassReading, Grading, PackingError};
use ballast_gpr::units::{Metres, Pascals, Seconds, Share};

const TWO: NonZeroUsize = NonZeroUsize::new(2).unwrap();

/// Spheres of 40 mm to a thousandth: two sieves with everything between them.
fn equal() -> Grading {
    let text = "sieve_mm,passing_percent\n39.98,0\n40.02,100\n";
    Grading::from_csv("equal", text).unwrap()
}

/// A periodic box of six diameters each way, soft grains for speed: overlaps stay under a hundredth of a diameter.
fn input(stones: usize) -> SettleInput {
    SettleInput {
        size: [Metres(0.24), Metres(0.24), Metres(0.5)],
        periodic: [true; 2],
        grading: equal(),
        class_reading: ClassReading::En933,
        how: SettleSpec {
            young: Pascals(1e8),
            stones: Some(stones),
            energy_ratio: 1e-8,
            unbalanced_ratio: 1e-3,
            longest: Seconds(6.0),
            ..SettleSpec::default()
        },
    }
}

/// Random close packing of equal spheres without friction: 0.64 of the volume (Bernal & Finney; Scott & Kilgour 1969: 0.6366)
/// and, because the packing is isostatic, six contacts for each that carries (O'Hern et al. 2003). Taken four diameters
/// above the floor, whose layers are denser, to two below the surface. ±0.01: what the literature's figures differ by. Contacts
/// beyond six grow as the square root of the overlap (O'Hern et al.): 6.58 at 0.1 GPa leaves about 6.27 at 1 GPa, where
/// overlaps are 4.6 times less; and six contacts of some 400 spheres are known to 0.1.
#[test]
fn equal_spheres_without_friction_pack_to_064() {
    let mut input = input(560);
    input.how.young = Pascals(1e9);
    input.how.friction = 0.0;
    input.how.rolling_friction = 0.0;
    let settled = settle(&input, 1, NonZeroUsize::MIN, None, &|_| ControlFlow::Continue(())).unwrap();
    assert!(settled.stages.iter().all(|stage| stage.at_rest), "{:?}", settled.stages);
    assert_eq!((settled.lost, settled.struck_off, settled.bed.count()), (0, 0, 560));
    let (bed, top) = (&settled.bed, settled.bed.top().si());
    let share = bed.solid_share_in([0.0, 0.0, 0.16], [0.24, 0.24, top - 0.08]).si();
    assert!((share - 0.64).abs() < 0.01, "{share}");
    let contacts = bed.coordination(Metres(0.0));
    assert!((5.8..6.4).contains(&contacts.interior_without_rattlers), "{contacts:?}");
    assert!(bed.deepest_overlap().unwrap().depth.si() < 1e-4, "{:?}", bed.deepest_overlap());
    // Newton: the contacts carry the weight, so their mean force is a fraction of the column's and not nothing.
    assert!(bed.force_distribution().unwrap().mean_newtons > 0.1);
}

/// Random loose packing: 0.55 to 0.57 with high friction (Onoda & Liniger 1990: 0.555; Song, Wang & Makse 2008: 0.536 at least).
/// Friction of 1 from the start, and rolling friction of 0.03, a tenth of that of ballast: spheres that roll freely pack to 0.58
/// when they are dropped. ±0.005 beyond the range for 560 spheres, whose seeds differ by 0.003. Between four contacts (the
/// isostatic number with friction) and five.
#[test]
fn equal_spheres_with_friction_pack_loosely() {
    let mut input = input(560);
    input.how.young = Pascals(1e9);
    (input.how.friction, input.how.rolling_friction) = (1.0, 0.03);
    (input.how.friction_while_falling, input.how.energy_ratio, input.how.unbalanced_ratio) = (true, 1e-7, 1e-2);
    let settled = settle(&input, 1, NonZeroUsize::MIN, None, &|_| ControlFlow::Continue(())).unwrap();
    assert!(settled.stages.iter().all(|stage| stage.at_rest), "{:?}", settled.stages);
    assert_eq!(settled.stages[0].name, "fall, with friction");
    let (bed, top) = (&settled.bed, settled.bed.top().si());
    let share = bed.solid_share_in([0.0, 0.0, 0.16], [0.24, 0.24, top - 0.08]).si();
    assert!((0.545..0.575).contains(&share), "{share}");
    let contacts = bed.coordination(Metres(0.0)).interior;
    assert!((4.0..5.0).contains(&contacts), "{contacts}");
}

/// The tank's ballast, dropped with a friction of 0.6, has the voids of ballast: 38 to 45 %; and without friction it packs denser,
/// to less than 38 % (spheres of many sizes). Soft stones and some three hundred of them, for speed.
#[test]
fn dropped_ballast_has_the_voids_of_ballast() {
    let mut input = input(300);
    (input.grading, input.size) = (Grading::benedetto2018().unwrap(), [Metres(0.3), Metres(0.3), Metres(0.4)]);
    (input.how.young, input.how.friction, input.how.rolling_friction) = (Pascals(3e8), 0.6, 0.0);
    (input.how.energy_ratio, input.how.unbalanced_ratio) = (1e-6, 3e-2);
    let voids = |rubbing: bool| {
        let mut input = input.clone();
        input.how.friction_while_falling = rubbing;
        let settled = settle(&input, 1, NonZeroUsize::MIN, None, &|_| ControlFlow::Continue(())).unwrap();
        1.0 - settled.bed.interior_solid_share().si()
    };
    let (dropped, dense) = (voids(true), voids(false));
    assert!((0.38..0.45).contains(&dropped), "{dropped}");
    assert!((0.32..0.38).contains(&dense), "{dense}");
}

/// A bed that was stopped, twice, and taken up again has the bits of one that was not, on another number of threads too.
#[test]
fn a_stop_changes_nothing() {
    let mut input = input(80);
    input.how.longest = Seconds(0.6);
    let through = settle(&input, 4, NonZeroUsize::MIN, None, &|_| ControlFlow::Continue(())).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for looks in [17, 30] {
        let left = Cell::new(looks);
        let stopped = settle(&input, 4, TWO, Some(folder.path()), &|_| {
            left.set(left.get() - 1);
            if left.get() == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert!(matches!(stopped, Err(SettleError::Stopped)));
        assert!(folder.path().join(STATE).is_file());
    }
    let resumed = settle(&input, 4, TWO, Some(folder.path()), &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(resumed.bed, through.bed);
    assert!(!folder.path().join(STATE).exists());
}

/// Nothing above the height that was asked for but what reaches over it from a centre below.
#[test]
fn a_bed_is_struck_off_at_its_height() {
    let mut input = input(0);
    input.how.stones = None;
    input.size[2] = Metres(0.12);
    let settled = settle(&input, 2, TWO, None, &|_| ControlFlow::Continue(())).unwrap();
    assert!(settled.struck_off > 0);
    // Friction lets the bed sink by less than a tenth of a millimetre once its top is off.
    let top = settled.bed.spheres.iter().map(|s| s.centre[2]).fold(0.0, f64::max);
    assert!((0.10..0.1201).contains(&top), "{top}");
}

#[test]
fn what_cannot_settle_is_refused() {
    let refused = |change: &dyn Fn(&mut SettleInput)| {
        let mut input = input(10);
        change(&mut input);
        settle(&input, 1, TWO, None, &|_| ControlFlow::Continue(())).unwrap_err()
    };
    let error = refused(&|input| input.how.energy_ratio = 0.0);
    assert_eq!(error.to_string(), "`packing.dem.energy_ratio` is 0, but must be above 0");
    let error = refused(&|input| input.size[0] = Metres(0.03));
    assert!(matches!(error, SettleError::Packing(PackingError::StoneLargerThanBox { .. })), "{error}");
    let error = refused(&|input| input.how.young = Pascals(-1.0));
    assert!(matches!(error, SettleError::Dem(_)), "{error}");
    let error = refused(&|input| (input.how.column, input.how.stones) = (Share(0.6), Some(300)));
    assert!(matches!(error, SettleError::Packing(PackingError::BoxIsFull { .. })), "{error}");
}

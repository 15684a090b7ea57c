//! Fenchel–Nielsen coordinates under changes of the marking, and there and back.

use super::fenchel_nielsen::{PantsCurve, fenchel_nielsen};
use super::{fenchel_nielsen_of_loops, pants_of_words};
use crate::canonical::{Quotient, QuotientOptions, quotient_of, uniformize_quotient};
use crate::embed::DeckGroup;
use crate::flow::{Flow, Options};
use crate::geometry::random::SplitMix64;
use crate::geometry::{DoubleDouble, Motion, Space};
use crate::mesh::shapes::{self, FenchelNielsen, PantsSurface};
use crate::mesh::{HalfedgeId, PerVertex};
use crate::metric::{Class, Scheme};
use crate::topology::{SurfaceGroup, Word};
use crate::{Control, Error, Surface};

fn quotient(genus: usize) -> Quotient {
    let surface = Surface::from_soup(&shapes::tapered_genus(genus, 4, 1.3).unwrap()).unwrap();
    uniformize_quotient(&surface, &QuotientOptions::default(), &Control::new()).unwrap()
}

fn coordinates(deck: &DeckGroup) -> Vec<[f64; 2]> {
    fenchel_nielsen(deck).unwrap().iter().map(|c| [c.length, c.twist]).collect()
}

#[test]
fn twists_turn_with_dehn_twists_alone() {
    for genus in 2..=5 {
        let deck = quotient(genus).deck;
        let before = coordinates(&deck);
        assert_eq!(before.len(), 3 * genus - 3);
        for i in 0..genus {
            // b ↦ b a leaves the commutators as they are.
            let mut turned = deck.clone();
            turned.generators[2 * i + 1] = deck.generators[2 * i + 1].compose(&deck.generators[2 * i]);
            for (k, (x, y)) in before.iter().zip(coordinates(&turned)).enumerate() {
                let by = if k == i { (y[1] - x[1]).abs() / x[0] } else { (y[1] - x[1]).abs() + 1.0 };
                assert!(
                    (by - 1.0).abs() < 1e-9 && (x[0] - y[0]).abs() < 1e-10,
                    "genus {genus}, {i}, {k}: {x:?} {y:?}"
                );
            }
        }
    }
}

#[test]
fn conjugates_have_the_same_coordinates() {
    for genus in 2..=4 {
        let deck = quotient(genus).deck;
        // The plane is moved by 1.5 and turned; farther motions cost e^{2 distance} of the digits.
        let turn = Motion::rotation([0.6.into(), 0.8.into()], Space::H2);
        let by = turn.compose(&Motion::<DoubleDouble>::translation(1.5, Space::H2).normalised()).normalised();
        let mut moved = deck.clone();
        moved.generators.iter_mut().for_each(|g| *g = g.conjugated_by(&by).normalised());
        for (x, y) in coordinates(&deck).iter().zip(coordinates(&moved)) {
            assert!((x[0] - y[0]).abs() < 1e-8 && (x[1] - y[1]).abs() < 1e-8, "genus {genus}: {x:?} {y:?}");
        }
    }
}

#[test]
fn other_surfaces_are_refused() {
    let torus = Surface::from_soup(&shapes::torus(2.0, 1.0, 8, 8).unwrap()).unwrap();
    let flat = uniformize_quotient(&torus, &QuotientOptions::default(), &Control::new()).unwrap();
    assert!(matches!(fenchel_nielsen(&flat.deck), Err(Error::Layout(_))));
}

fn loops_of(marked: &PantsSurface) -> Vec<Vec<HalfedgeId>> {
    let halfedge = |&e: &i32| HalfedgeId(2 * (e.unsigned_abs() - 1) + u32::from(e < 0));
    marked.loops.iter().map(|path| path.iter().map(halfedge).collect()).collect()
}

fn surface_of(marked: &PantsSurface) -> Surface {
    let (mesh, lengths) = marked.surface.build().unwrap();
    Surface::intrinsic(mesh, lengths, Space::H2).unwrap()
}

/// Random coordinates with lengths in [0.3, 6] and twists of both signs.
fn random_coordinates(genus: usize, n_boundaries: usize, random: &mut SplitMix64) -> FenchelNielsen {
    let mut unit = || (random.bits() >> 11) as f64 / (1u64 << 53) as f64;
    let curves =
        (0..3 * genus + n_boundaries - 3).map(|_| [0.3 + 5.7 * unit(), 8.0 * unit() - 4.0]).collect();
    let boundaries = (0..n_boundaries).map(|_| 0.5 + 3.0 * unit()).collect();
    FenchelNielsen { genus, curves, boundaries }
}

fn largest_difference(expected: &FenchelNielsen, found: &[PantsCurve]) -> f64 {
    assert_eq!(expected.curves.len(), found.len());
    let off = expected.curves.iter().zip(found).flat_map(|(x, y)| [x[0] - y.length, x[1] - y.twist]);
    off.map(f64::abs).fold(0.0, f64::max)
}

const TOPOLOGIES: [(usize, usize); 12] =
    [(2, 0), (3, 0), (4, 0), (5, 0), (6, 0), (1, 1), (1, 2), (2, 1), (2, 3), (3, 1), (0, 4), (0, 6)];

#[test]
fn coordinates_lead_to_a_group_and_back() {
    let mut random = SplitMix64::new(11);
    for (genus, boundaries) in TOPOLOGIES {
        for _ in 0..10 {
            let given = random_coordinates(genus, boundaries, &mut random);
            let marked = shapes::fenchel_nielsen(&given, 0).unwrap();
            let surface = surface_of(&marked);
            assert_eq!((surface.mesh().genus(), surface.mesh().boundary_loops().len()), (genus, boundaries));
            let of = uniformized_by_itself(&marked, SurfaceGroup { genus, boundaries });
            assert!(of.relation_residual < 1e-20, "{given:?}: {}", of.relation_residual);
            let off = largest_difference(&given, &fenchel_nielsen(&of).unwrap());
            assert!(off < 1e-10, "{given:?}: {off:e}");
            for (k, length) in given.boundaries.iter().enumerate() {
                let found = of.generators[2 * genus + k].translation_length();
                assert!((found - length).abs() < 1e-12, "{found} {length}");
            }
        }
    }
}

/// A deck group of the generators that the gluing computed.
fn uniformized_by_itself(marked: &PantsSurface, group: SurfaceGroup) -> DeckGroup {
    let mut deck = quotient(2).deck;
    (deck.group, deck.generators) = (group, marked.generators.clone());
    let whole = deck.motion(&group.relator()).unwrap();
    deck.relation_residual = whole.distance_from_identity()
        / marked.generators.iter().map(Motion::norm_square).fold(1.0, f64::max);
    deck
}

#[test]
fn coordinates_lead_to_a_surface_and_back() {
    let mut random = SplitMix64::new(5);
    for (genus, boundaries) in TOPOLOGIES.into_iter().filter(|t| *t != (6, 0) && t.0 > 0) {
        let given = random_coordinates(genus, boundaries, &mut random);
        let marked = shapes::fenchel_nielsen(&given, usize::from(genus < 4)).unwrap();
        let of =
            uniformize_quotient(&surface_of(&marked), &QuotientOptions::default(), &Control::new()).unwrap();
        let found = fenchel_nielsen_of_loops(&of, &loops_of(&marked), &Control::new()).unwrap();
        let off = largest_difference(&given, &found);
        assert!(off < 1e-10, "genus {genus}, {boundaries}: {off:e}");
    }
}

/// From a metric of random curvature in the same conformal class.
#[test]
fn a_change_of_the_metric_changes_no_coordinate() {
    let mut random = SplitMix64::new(7);
    let control = Control::new();
    for (genus, boundaries) in [(2, 0), (3, 0), (4, 0), (5, 0)] {
        let given = random_coordinates(genus, boundaries, &mut random);
        let marked = shapes::fenchel_nielsen(&given, 1).unwrap();
        let surface = surface_of(&marked);
        let class = Class::new(Scheme::Yamabe, Space::H2);
        let mut flow = Flow::new(surface.clone(), class, &Options::default(), &control).unwrap();
        let mut unit = || (random.bits() >> 11) as f64 / (1u64 << 53) as f64;
        let target = PerVertex::from_fn(surface.mesh().n_vertices(), |_| 0.3 * (unit() - 0.5));
        let reached = flow.reach(&target, &control).unwrap().is_reached();
        let changed = flow.solution();
        let of = quotient_of(&changed, &QuotientOptions::default(), &control).unwrap();
        let found = fenchel_nielsen_of_loops(&of, &loops_of(&marked), &control).unwrap();
        let off = largest_difference(&given, &found);
        let factor = changed.conformal_factor().unwrap();
        let range = factor.iter().fold([f64::INFINITY, 0.0], |[a, b], &x| [x.min(a), x.max(b)]);
        assert!(reached && range[1] > 1.05 * range[0] && off < 1e-10, "genus {genus}: {off:e} {range:?}");
    }
}

fn words(of: &Quotient, all: &[&str]) -> Vec<Word> {
    all.iter().map(|text| of.deck.group.parse(text).unwrap()).collect()
}

fn named(of: &Quotient, all: &[&str]) -> Result<Vec<PantsCurve>, Error> {
    pants_of_words(of, &words(of, all), 1_000_000, &Control::new())
}

#[test]
fn named_words_have_the_coordinates_of_the_canonical_ones() {
    for of in [quotient(2)] {
        let canonical = fenchel_nielsen(&of.deck).unwrap();
        let all: Vec<Word> = canonical.iter().map(|c| c.word.clone()).collect();
        let found = pants_of_words(&of, &all, 1_000_000, &Control::new()).unwrap();
        for (x, y) in canonical.iter().zip(&found) {
            assert!((x.length - y.length).abs() < 1e-10, "{x:?} {y:?}");
            // Modulo half of the length.
            let turns = (x.twist - y.twist) / (0.5 * x.length);
            assert!(
                (turns - turns.round()).abs() < 1e-8 && y.twist.abs() <= 0.2500001 * y.length,
                "{x:?} {y:?}"
            );
        }
        // Conjugates, and words of inverses, name the same curves.
        let by = &of.deck.group.parse("b1 a2").unwrap();
        let others: Vec<Word> = all.iter().map(|w| by.times(&w.inverse()).times(&by.inverse())).collect();
        for (x, y) in found.iter().zip(pants_of_words(&of, &others, 1_000_000, &Control::new()).unwrap()) {
            assert!((x.length - y.length).abs() < 1e-10 && (x.twist - y.twist).abs() < 1e-8, "{x:?} {y:?}");
        }
    }
}

#[test]
fn words_that_name_no_pants_are_refused_by_name() {
    let of = quotient(2);
    let says = |all: &[&str], what: &str| {
        let error = named(&of, all).unwrap_err().to_string();
        assert!(error.contains(what), "{all:?}: {error}");
    };
    says(&["a1", "b1", "a2"], "a1 and b1 cross");
    says(&["a1 b1 a1^-1 b1^-1 a1", "a2", "a1 a2"], "crosses itself");
    says(&["a1", "a1", "a2"], "are one curve");
    says(&["a1 a1", "a2", "a1 b1 a1^-1 b1^-1"], "several times");
    says(&["1", "a2", "a1"], "can be contracted");
    assert!(matches!(named(&of, &["a1", "a2"]), Err(Error::Size { .. })));
    assert!(named(&of, &["a1", "a2", "a1 a2"]).is_ok() || named(&of, &["a1", "a2", "a1 a2^-1"]).is_ok());
}

#[test]
fn loops_that_are_no_basis_are_refused() {
    let marked = shapes::fenchel_nielsen(
        &FenchelNielsen { genus: 2, curves: vec![[2.0, 0.3]; 3], boundaries: vec![] },
        0,
    )
    .unwrap();
    let of = uniformize_quotient(&surface_of(&marked), &QuotientOptions::default(), &Control::new()).unwrap();
    let loops = loops_of(&marked);
    let with = |loops: &[Vec<HalfedgeId>]| fenchel_nielsen_of_loops(&of, loops, &Control::new());
    assert!(matches!(with(&loops[1..]), Err(Error::Size { .. })));
    let swapped = vec![loops[1].clone(), loops[2].clone(), loops[0].clone(), loops[3].clone()];
    assert!(with(&swapped).unwrap_err().to_string().contains("canonical basis"));
    let open = vec![loops[0][1..].to_vec(), loops[1].clone(), loops[2].clone(), loops[3].clone()];
    assert!(matches!(with(&open), Err(Error::Argument { .. })));
}

/// Half turns about feet of seams bring such surfaces to themselves.
#[test]
fn loops_of_symmetric_surfaces_close() {
    for genus in 2..=4 {
        for length in [0.3, 1.0, 2.6, 3.0] {
            let given =
                FenchelNielsen { genus, curves: vec![[length, 0.0]; 3 * genus - 3], boundaries: vec![] };
            let marked = shapes::fenchel_nielsen(&given, 0).unwrap();
            assert!(marked.loops.len() == 2 * genus && marked.loops.iter().all(|path| !path.is_empty()));
        }
    }
}

#[test]
fn numbers_that_are_no_coordinates_are_refused() {
    let with = |genus: usize, curves: Vec<[f64; 2]>, boundaries: Vec<f64>| {
        shapes::fenchel_nielsen(&FenchelNielsen { genus, curves, boundaries }, 0)
    };
    assert!(matches!(with(1, vec![], vec![]), Err(Error::Argument { .. })));
    assert!(matches!(with(2, vec![[1.0, 0.0]; 2], vec![]), Err(Error::Size { .. })));
    assert!(matches!(with(2, vec![[0.0, 0.0]; 3], vec![]), Err(Error::Argument { .. })));
    assert!(matches!(with(2, vec![[1.0, f64::NAN]; 3], vec![]), Err(Error::Argument { .. })));
    assert!(matches!(with(2, vec![[1.0, 0.0]; 3], vec![1.0]), Err(Error::Size { .. })));
    // Twists that are multiples of half of the length, where feet of both sides meet.
    let straight = with(2, vec![[1.0, 0.0], [2.0, 1.0], [3.0, -1.5]], vec![]).unwrap();
    let surface = surface_of(&straight);
    let area = surface.area().unwrap();
    assert!((area - 4.0 * std::f64::consts::PI).abs() < 1e-12, "{area}");
}

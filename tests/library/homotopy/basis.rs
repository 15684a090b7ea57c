//! Tests of homotopy bases: relator, intersection numbers, words of paths, lifts.

use crate::homotopy::representation::{Representation, identity};
use crate::homotopy::samples::*;
use crate::surfaces::{Random, flat_torus, octagon, tetrahedron};
use ricci::mesh::{HalfedgeId, Mesh, PerEdge, VertexId, shapes};
use ricci::topology::*;
use ricci::{Control, Error};

/// Homomorphisms tried per surface.
const REPRESENTATIONS: usize = 3;

fn check(name: &str, mesh: &Mesh, basis: &HomotopyBasis) {
    let group = basis.group;
    assert_eq!((group.genus, group.boundaries), (mesh.genus(), mesh.boundary_loops().len()), "{name}");
    assert_eq!(basis.loops.len(), group.n_generators());
    for (k, path) in basis.loops.iter().enumerate() {
        assert!(path.windows(2).all(|pair| mesh.tip(pair[0]) == mesh.origin(pair[1])), "{name}: broken loop");
        assert!(path.first().is_none_or(|&h| mesh.origin(h) == basis.base), "{name}: base");
        assert!(path.last().is_none_or(|&h| mesh.tip(h) == basis.base), "{name}: base");
        let word = basis.path_word(mesh, path).unwrap();
        let generator = Word::from_iter([Letter::generator(k)]);
        assert!(group.equal(&word, &generator), "{name}: loop {k} is {}", group.text(&word));
    }
    let matrix = intersection_matrix(mesh, &basis.loops).unwrap();
    for (i, row) in matrix.iter().enumerate() {
        for (j, &number) in row.iter().enumerate() {
            let handle = i / 2 == j / 2 && i.max(j) < 2 * group.genus;
            let standard = i64::from(handle) * (i64::from(i < j) - i64::from(i > j));
            assert_eq!(number, standard, "{name}: {} · {}", group.name(i), group.name(j));
        }
    }
    let rims: std::collections::BTreeSet<_> = basis.rims.iter().map(|h| h.0).collect();
    let all = mesh.boundary_loops();
    assert!(all.iter().all(|rim| rim.iter().filter(|h| rims.contains(&h.twin().0)).count() == 1), "{name}");
    for (j, &h) in basis.rims.iter().enumerate() {
        let rim = all.iter().find(|rim| rim.contains(&h.twin())).unwrap();
        let at = rim.iter().position(|&k| k == h.twin()).unwrap();
        let around = reversed(&[&rim[at..], &rim[..at]].concat());
        let word = basis.path_word(mesh, &around).unwrap();
        let c = Word::from_iter([Letter::generator(2 * group.genus + j)]);
        assert!(group.equal(&word, &c), "{name}: boundary loop {j} is {}", group.text(&word));
    }
    // The words of half-edges are a homomorphism: around each face, and along each edge and back, they cancel.
    for h in mesh.halfedges() {
        let there_and_back = basis.halfedge_word(mesh, h).times(&basis.halfedge_word(mesh, h.twin()));
        assert!(group.is_trivial(&there_and_back), "{name}: half-edge {h}");
        let across = basis.transition(mesh, h).times(&basis.transition(mesh, h.twin()));
        assert!(group.is_trivial(&across), "{name}: across half-edge {h}");
        assert!(mesh.face(h).is_some() || basis.transition(mesh, h).is_empty());
    }
    for f in mesh.faces() {
        assert!(basis.path_word(mesh, &mesh.face_halfedges(f)).unwrap().is_empty(), "{name}: face {f}");
    }
    // Turning once around an inner vertex leads back into the same copy of the polygon.
    for v in mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)) {
        let around = mesh.outgoing(v).map(|h| basis.transition(mesh, h));
        assert!(group.is_trivial(&around.fold(Word::identity(), |w, t| w.times(&t))), "{name}: vertex {v}");
    }
}

/// Compares words with homomorphisms made of faces, and with intersection numbers.
fn check_words<const N: usize>(name: &str, mesh: &Mesh, basis: &HomotopyBasis, random: &mut Random) {
    let loops = &basis.loops;
    let relator = relator_path(basis);
    for _ in 0..REPRESENTATIONS {
        let rho = Representation::<N>::random(mesh, random);
        assert_eq!(rho.path(&relator), identity(), "{name}: relator");
        for steps in [0, 1, 5, 40, 200] {
            let path = random_loop(mesh, basis, steps, random);
            let word = basis.path_word(mesh, &path).unwrap();
            assert_eq!(rho.path(&path), rho.word(loops, &word), "{name}: {}", basis.group.text(&word));
            let sums = basis.group.abelianisation(&word);
            for i in 0..basis.group.genus {
                let a = intersection_number(mesh, &path, &loops[2 * i + 1]).unwrap();
                let b = intersection_number(mesh, &loops[2 * i], &path).unwrap();
                assert_eq!([sums[2 * i], sums[2 * i + 1]], [a, b], "{name}");
            }
        }
    }
}

#[test]
fn bases_of_generated_surfaces_are_canonical() {
    let mut random = Random(1);
    for (name, mesh, lengths) in generated() {
        let basis = basis_of(&mesh, &lengths);
        check(&name, &mesh, &basis);
        if mesh.is_closed() {
            check_words::<4>(&name, &mesh, &basis, &mut random);
        } else {
            check_words::<5>(&name, &mesh, &basis, &mut random);
        }
    }
}

#[test]
fn bases_of_the_corpus_are_canonical() {
    let mut random = Random(2);
    for (name, mesh, lengths) in corpus() {
        let basis = basis_of(&mesh, &lengths);
        check(&name, &mesh, &basis);
        check_words::<4>(&name, &mesh, &basis, &mut random);
    }
}

#[test]
fn every_base_vertex_and_every_metric_will_do() {
    let mut random = Random(3);
    for (name, mesh, _) in generated() {
        for _ in 0..3 {
            let base = VertexId::from(random.below(mesh.n_vertices()));
            let lengths = PerEdge::from_fn(mesh.n_edges(), |_: ricci::mesh::EdgeId| 0.1 + random.real());
            let basis = homotopy_basis(&mesh, &lengths, Some(base), &Control::new()).unwrap();
            assert_eq!(basis.base, base);
            check(&name, &mesh, &basis);
            check_words::<4>(&name, &mesh, &basis, &mut random);
        }
    }
}

/// The homomorphisms distinguish a wrong relator from the right one.
#[test]
fn a_wrong_relator_is_seen() {
    let mut random = Random(4);
    let (_, mesh, lengths) = from_soup("genus 2", &shapes::genus(2, 2).unwrap());
    let basis = basis_of(&mesh, &lengths);
    let right = basis.group.relator();
    let wrong = basis.group.parse("a1 b1 a2 b2 a1^-1 b1^-1 a2^-1 b2^-1").unwrap();
    let rho: Vec<_> = (0..10).map(|_| Representation::<4>::random(&mesh, &mut random)).collect();
    assert!(rho.iter().all(|rho| rho.word(&basis.loops, &right) == identity()));
    assert!(rho.iter().any(|rho| rho.word(&basis.loops, &wrong) != identity()));
}

/// A contractible loop, made by inserting spurs and faces at random.
fn contractible(mesh: &Mesh, start: VertexId, moves: usize, random: &mut Random) -> Vec<HalfedgeId> {
    let mut path: Vec<HalfedgeId> = Vec::new();
    for _ in 0..moves {
        let at = random.below(path.len() + 1);
        let v = if at == 0 { start } else { mesh.tip(path[at - 1]) };
        let out: Vec<_> = mesh.outgoing(v).collect();
        let h = out[random.below(out.len())];
        let detour = if random.below(2) == 0 || mesh.is_outside(h) {
            vec![h, h.twin()]
        } else {
            vec![h, mesh.next(h), mesh.prev(h)]
        };
        path.splice(at..at, detour);
    }
    path
}

#[test]
fn contractible_loops_lift_to_loops_and_others_end_where_their_word_says() {
    let mut random = Random(5);
    for (name, mesh, lengths) in generated() {
        let basis = basis_of(&mesh, &lengths);
        let group = basis.group;
        for round in 0..10 {
            let start = random.below(mesh.n_vertices());
            let start = Lift {
                vertex: VertexId::from(start),
                element: basis.path_word(&mesh, &random_loop(&mesh, &basis, 20, &mut random)).unwrap(),
            };
            let path = contractible(&mesh, start.vertex, 30, &mut random);
            let lifts: Vec<_> = basis.lift(&mesh, &start, &path).unwrap().collect();
            assert_eq!(lifts.len(), path.len() + 1);
            assert!(lifts.iter().zip(&path).all(|(lift, &h)| lift.vertex == mesh.origin(h)));
            let end = &lifts[lifts.len() - 1];
            assert!(group.equal(&end.element, &start.element), "{name}: an open lift");

            // Lifting is an action: lifting along one path and then another equals lifting along both.
            let (p, q) =
                (random_loop(&mesh, &basis, 30, &mut random), random_loop(&mesh, &basis, round, &mut random));
            let base = basis.tree_lift(basis.base);
            let middle = basis.lift(&mesh, &base, &p).unwrap().last().unwrap();
            let end = basis.lift(&mesh, &middle, &q).unwrap().last().unwrap();
            let words = [&p, &q].map(|path| basis.path_word(&mesh, path).unwrap());
            assert!(group.equal(&end.element, &words[0].times(&words[1])), "{name}");
            assert_eq!(end.vertex, basis.base);
        }
        // The tree lift of a vertex is the end of the tree path's lift.
        for v in mesh.vertices() {
            let path = basis.tree_path(&mesh, v).unwrap();
            let end = basis.lift(&mesh, &basis.tree_lift(basis.base), &path).unwrap().last().unwrap();
            assert_eq!(end, basis.tree_lift(v), "{name}");
        }
        let relator = relator_path(&basis);
        let end = basis.lift(&mesh, &basis.tree_lift(basis.base), &relator).unwrap().last().unwrap();
        assert!(end.element.is_empty(), "{name}");
        if group.genus > 1 {
            let ends =
                basis.lift(&mesh, &basis.tree_lift(basis.base), &relator[..basis.loops[0].len()]).unwrap();
            assert_eq!(ends.last().unwrap().element, group.parse("a1").unwrap(), "{name}");
        }
    }
}

#[test]
fn walls_of_copies_agree_with_lifts_of_their_corners() {
    // When h is crossed out of the copy γ D, the corner at h's origin is the same lift in both copies.
    for (name, mesh, lengths) in generated() {
        let basis = basis_of(&mesh, &lengths);
        for h in mesh.halfedges().filter(|h| !mesh.is_boundary_edge(h.edge())) {
            let pairs = [(h, mesh.next(h.twin())), (mesh.next(h), h.twin())];
            for (here, there) in pairs {
                let from_there = basis.transition(&mesh, h).times(&basis.corner_word(there));
                assert!(basis.group.equal(&basis.corner_word(here), &from_there), "{name}");
            }
        }
        let at_base = mesh.outgoing(basis.base).filter(|&h| !mesh.is_outside(h));
        assert!(
            at_base.into_iter().any(|h| basis.corner_word(h).is_empty()),
            "{name}: D has a corner at the base lift"
        );
        let most = 8 * basis.group.genus + 2 * basis.group.boundaries;
        let longest = mesh.halfedges().map(|h| basis.corner_word(h).len()).max().unwrap();
        assert!(longest <= 3 * most, "{name}: a corner word of {longest} letters");
    }
}

fn length(path: &[HalfedgeId], lengths: &PerEdge<f64>) -> f64 {
    path.iter().map(|h| lengths[h.edge()]).sum()
}

#[test]
fn loops_are_short() {
    // A flat torus: the two shortest vectors of the lattice that run along edges.
    for tau in [[0.0, 1.0], [0.3, 1.2]] {
        let (mesh, lengths) = flat_torus(12, 12, tau);
        let basis = basis_of(&mesh, &lengths);
        let shortest = 1.0 + tau[0].hypot(tau[1]);
        assert!((basis.length(&lengths) - shortest).abs() < 1e-9, "{}", basis.length(&lengths));
    }
    // A torus of revolution: a meridian of length 2πr, and at most the inner equator in addition, both as polygons of chords.
    let (_, mesh, lengths) = from_soup("torus", &shapes::torus(2.0, 0.5, 60, 24).unwrap());
    let basis = basis_of(&mesh, &lengths);
    let most = std::f64::consts::TAU * (0.5 + 1.5 + 0.1);
    assert!(basis.length(&lengths) < most, "{} of {most}", basis.length(&lengths));
    // The octagon's sides are its loops.
    let (mesh, lengths) = octagon();
    assert!((basis_of(&mesh, &lengths).length(&lengths) - 4.0).abs() < 1e-12);
    // The greedy loops are the shortest generating loops through a vertex in total [EW05]; canonical ones, on smooth surfaces of genus 2
    // to 5, are less than three times as long as those through the best of some vertices.
    for g in 2..=5 {
        let (name, mesh, lengths) = from_soup(&format!("genus {g}"), &shapes::genus(g, 3).unwrap());
        let greedy: f64 = homology_generators(&mesh, &lengths, &Control::new())
            .unwrap()
            .iter()
            .map(|path| length(path, &lengths))
            .sum();
        let total = basis_of(&mesh, &lengths).length(&lengths);
        assert!(total < 3.0 * greedy, "{name}: {total} against {greedy}");
    }
    // No fan shortens a loop any further.
    for (name, mesh, lengths) in generated() {
        for path in &basis_of(&mesh, &lengths).loops {
            for pair in path.windows(2) {
                let old = length(pair, &lengths);
                for (from, to) in [(pair[1], pair[0].twin()), (pair[0].twin(), pair[1])] {
                    let (mut h, mut way) = (from, Some(0.0));
                    while h != to {
                        let inside = !mesh.is_outside(h);
                        way = way.filter(|_| inside).map(|way| way + lengths[mesh.next(h).edge()]);
                        if !inside {
                            break;
                        }
                        h = mesh.prev(h).twin();
                    }
                    assert!(way.is_none_or(|way| way > old * (1.0 - 1e-9)), "{name}: a loop has slack");
                }
            }
        }
    }
}

#[test]
fn a_basis_depends_on_the_surface_alone() {
    for (name, mesh, lengths) in generated() {
        let [one, other] = [0, 1].map(|_| basis_of(&mesh, &lengths));
        assert_eq!((one.base, &one.loops), (other.base, &other.loops), "{name}");
        assert!(mesh.halfedges().all(|h| one.corner_word(h) == other.corner_word(h)), "{name}");
    }
}

#[test]
fn bad_input_is_named() {
    let (mesh, lengths) = tetrahedron();
    let control = Control::new();
    let outside = homotopy_basis(&mesh, &lengths, Some(VertexId(4)), &control);
    assert!(matches!(outside, Err(Error::Argument { .. })));
    let short = homotopy_basis(&mesh, &PerEdge::filled(5, 1.0), None, &control);
    assert!(matches!(short, Err(Error::Size { .. })));
    let negative = homotopy_basis(&mesh, &PerEdge::filled(6, -1.0), None, &control);
    assert!(matches!(negative, Err(Error::EdgeLength { edge: 0, .. })));
    let basis = homotopy_basis(&mesh, &lengths, None, &control).unwrap();
    let [h, far] = [HalfedgeId(0), HalfedgeId(99)];
    let unlinked = [h, h];
    assert!(matches!(basis.path_word(&mesh, &unlinked), Err(Error::Argument { .. })));
    assert!(matches!(basis.path_word(&mesh, &[far]), Err(Error::Argument { .. })));
    assert!(matches!(intersection_number(&mesh, &[h], &[]), Err(Error::Argument { .. })));
    let elsewhere = Lift { vertex: mesh.tip(h), element: Word::identity() };
    assert!(matches!(basis.lift(&mesh, &elsewhere, &[h]), Err(Error::Argument { .. })));
    assert!(matches!(basis.path_word(&octagon().0, &[]), Err(Error::Size { .. })));
    control.cancel();
    assert_eq!(homotopy_basis(&mesh, &lengths, None, &control).err(), Some(Error::Cancelled));
}

//! The homotopy class that pairs of loops name: the map brings each loop to its partner, whatever its energy is, or the error says why no
//! map does.

use super::samples::{apart, apart_from, check_map, moved, surface};
use ricci::matching::{MatchOptions, Matching, match_surfaces};
use ricci::mesh::io::Soup;
use ricci::mesh::shapes::SplitMix64;
use ricci::mesh::{HalfedgeId, VertexId, shapes};
use ricci::topology::{HomotopyBasis, Letter, Word, homotopy_basis, shortest_paths};
use ricci::{Control, Result, Surface};

type Loops = Vec<HalfedgeId>;

fn basis_of(surface: &Surface) -> HomotopyBasis {
    homotopy_basis(surface.mesh(), surface.lengths(), None, &Control::new()).unwrap()
}

fn pairs(from: &[Loops], to: &[Loops]) -> Vec<[Loops; 2]> {
    from.iter().zip(to).map(|(a, b)| [a.clone(), b.clone()]).collect()
}

fn by(source: &Surface, target: &Surface, basis: Vec<[Loops; 2]>) -> Result<Matching> {
    match_surfaces(source, target, &MatchOptions { basis, ..MatchOptions::default() }, &Control::new())
}

fn back(path: &[HalfedgeId]) -> Loops {
    path.iter().rev().map(|h| h.twin()).collect()
}

fn torus() -> Surface {
    surface(&shapes::torus(2.0, 0.8, 36, 18).unwrap())
}

fn holed(n: usize) -> Surface {
    surface(&shapes::punch(&shapes::torus(2.0, 0.8, 36, 18).unwrap(), n).unwrap())
}

fn double_torus() -> Surface {
    surface(&moved(&shapes::genus(2, 8).unwrap(), |[x, y, z]| [x, y * (1.0 + 0.1 * x), z]))
}

/// The words of the images of loops that start at one vertex, which are drawn from vertex to vertex of the target along shortest paths.
fn image_words(
    matching: &Matching,
    target: &Surface,
    basis: &HomotopyBasis,
    loops: &[(&Surface, &Loops)],
) -> Vec<Word> {
    let near = matching.forward.nearest_vertices(target.mesh()).unwrap();
    let step = |from: VertexId, to: VertexId| {
        let forest = shortest_paths(target.mesh(), target.lengths(), vec![from], &Control::new()).unwrap();
        let mut path: Loops = forest.path(target.mesh(), to).collect();
        path.reverse();
        path
    };
    let word = |(source, path): &(&Surface, &Loops)| {
        let mesh = source.mesh();
        let of = |v: VertexId| near[v.index()];
        let image: Loops = path.iter().flat_map(|&h| step(of(mesh.origin(h)), of(mesh.tip(h)))).collect();
        basis.path_word(target.mesh(), &image).unwrap()
    };
    loops.iter().map(word).collect()
}

/// All words of at most this number of letters.
fn words(n_generators: usize, most: usize) -> Vec<Word> {
    let mut all = vec![Word::identity()];
    let mut first = 0;
    for _ in 0..most {
        let last = all.len();
        for k in first..last {
            for letter in (0..n_generators).map(Letter::generator).flat_map(|l| [l, l.inverse()]) {
                let mut next = all[k].clone();
                next.push(letter);
                all.push(next);
            }
        }
        first = last;
    }
    all
}

/// Asserts that the map brings all loops to their partners, up to one path between their starting points.
fn check_class(matching: &Matching, [source, target]: [&Surface; 2], pairs: &[[Loops; 2]]) {
    check_map(matching, source, target);
    assert_eq!(matching.markings, 1);
    let basis = basis_of(target);
    let loops: Vec<_> = pairs.iter().map(|pair| (source, &pair[0])).collect();
    let images = image_words(matching, target, &basis, &loops);
    let wanted: Vec<Word> =
        pairs.iter().map(|pair| basis.path_word(target.mesh(), &pair[1]).unwrap()).collect();
    let fits = |u: &Word| {
        let turned = images.iter().map(|w| u.times(w).times(&u.inverse()));
        turned.zip(&wanted).all(|(w, v)| basis.group.equal(&w, v))
    };
    assert!(words(basis.group.n_generators(), 3).iter().any(fits), "{images:?} {wanted:?}");
}

#[test]
fn a_surface_goes_to_itself_by_its_own_basis() {
    for surface in [torus(), holed(1), double_torus()] {
        let loops = basis_of(&surface).loops;
        let (all, few) = (pairs(&loops, &loops), 2 * surface.mesh().genus());
        for basis in [all.clone(), all[..few].to_vec()] {
            let matching = by(&surface, &surface, basis.clone()).unwrap();
            check_class(&matching, [&surface, &surface], &basis);
            assert!(apart(&matching, &surface) < 1e-8, "{}", apart(&matching, &surface));
        }
        // If all loops are conjugated by one of them, which is an inner automorphism, the class is the same.
        let around = |path: &Loops| [&loops[0][..], path, &back(&loops[0])].concat();
        let carried: Vec<Loops> = loops.iter().map(around).collect();
        let matching = by(&surface, &surface, pairs(&loops, &carried)).unwrap();
        assert!(apart(&matching, &surface) < 1e-8, "{}", apart(&matching, &surface));
    }
}

#[test]
fn a_twisted_basis_gives_the_twisted_map() {
    for surface in [torus(), holed(1), double_torus()] {
        let loops = basis_of(&surface).loops;
        let few = 2 * surface.mesh().genus();
        let mut twisted = loops[..few].to_vec();
        // A Dehn twist: b → b a.
        twisted[1] = [&loops[1][..], &loops[0]].concat();
        let basis = pairs(&loops[..few], &twisted);
        let matching = by(&surface, &surface, basis.clone()).unwrap();
        check_class(&matching, [&surface, &surface], &basis);
        let plain = by(&surface, &surface, pairs(&loops[..few], &loops[..few])).unwrap();
        assert!(matching.balance[0].energy > 1.05 * plain.balance[0].energy);
        // In the other direction it is the inverse.
        let inverse = by(&surface, &surface, pairs(&twisted, &loops[..few])).unwrap();
        check_class(&inverse, [&surface, &surface], &pairs(&twisted, &loops[..few]));
    }
}

#[test]
fn a_twist_that_homology_does_not_see_is_kept() {
    // Both loops of one handle are conjugated by the curve that separates it from the other handle.
    let surface = double_torus();
    let loops = basis_of(&surface).loops;
    let between = [&loops[0][..], &loops[1], &back(&loops[0]), &back(&loops[1])].concat();
    let mut twisted = loops.clone();
    for k in [0, 1] {
        twisted[k] = [&between[..], &loops[k], &back(&between)].concat();
    }
    let basis = pairs(&loops, &twisted);
    let matching = by(&surface, &surface, basis.clone()).unwrap();
    check_class(&matching, [&surface, &surface], &basis);
    assert!(apart(&matching, &surface) > 1e-2);
}

#[test]
fn other_surfaces_are_matched_in_the_named_class() {
    let [source, target] =
        [holed(2), surface(&shapes::punch(&shapes::torus(2.0, 0.6, 32, 20).unwrap(), 2).unwrap())];
    // The common class is found without naming it; its loops then give the same map again.
    let free = by(&source, &target, Vec::new()).unwrap();
    let [first, second] = [&source, &target].map(basis_of);
    let few = 3;
    let loops: Vec<_> = first.loops[..few].iter().map(|path| (&source, path)).collect();
    let images = image_words(&free, &target, &second, &loops);
    let path = |word: &Word| -> Loops {
        let letter = |l: &Letter| match l.is_inverse() {
            true => back(&second.loops[l.index()]),
            false => second.loops[l.index()].clone(),
        };
        word.letters().iter().flat_map(letter).collect()
    };
    let images: Vec<Loops> = images.iter().map(path).collect();
    let named = by(&source, &target, pairs(&first.loops[..few], &images)).unwrap();
    check_class(&named, [&source, &target], &pairs(&first.loops[..few], &images));
    let positions = target.positions().unwrap();
    let [a, b] = [&free, &named].map(|m| m.forward.carry(target.mesh(), positions).unwrap());
    let off = a.iter().zip(&b).map(|(p, q)| ricci::geometry::vector::distance(*p, *q)).fold(0.0, f64::max);
    assert!(off < 1e-6, "{off}");
}

/// A surface with its vertices in another order and its faces from the last to the first, and the new number of each vertex.
fn renumbered(soup: &Soup, seed: u64) -> (Surface, Vec<VertexId>) {
    let n = soup.positions.len();
    let (mut random, mut to) = (SplitMix64::new(seed), (0..n as u32).collect::<Vec<_>>());
    (1..n).for_each(|k| to.swap(k, (random.unit() * (k + 1) as f64) as usize));
    let mut other = soup.clone();
    for (v, &w) in to.iter().enumerate() {
        other.positions[w as usize] = soup.positions[v];
    }
    other.faces.iter_mut().for_each(|face| *face = face.map(|v| to[v as usize]));
    other.faces.reverse();
    (surface(&other), to.into_iter().map(VertexId).collect())
}

#[test]
fn a_surface_with_other_numbers_is_met_in_the_class_that_loops_name() {
    // Without names the search may take the map by another symmetry of the torus, which has the same energy.
    let soup = shapes::punch(&shapes::torus(2.0, 0.8, 36, 18).unwrap(), 1).unwrap();
    let source = surface(&soup);
    for seed in [1, 2] {
        let (target, to) = renumbered(&soup, seed);
        let other = |h: &HalfedgeId| {
            let [a, b] = [source.mesh().origin(*h), source.mesh().tip(*h)].map(|v| to[v.index()]);
            target.mesh().outgoing(a).find(|&g| target.mesh().tip(g) == b).unwrap()
        };
        let loops = basis_of(&source).loops[..2].to_vec();
        let carried: Vec<Loops> = loops.iter().map(|path| path.iter().map(other).collect()).collect();
        let matching = by(&source, &target, pairs(&loops, &carried)).unwrap();
        check_map(&matching, &source, &target);
        let positions = target.positions().unwrap();
        let off =
            apart_from(&matching, &target, |v| positions[to[v].index()]).into_iter().fold(0.0, f64::max);
        assert!(off < 1e-8, "{seed}: {off:e}");
    }
}

#[test]
fn loops_that_name_no_class_are_refused() {
    let refused = |surface: &Surface, basis: Vec<[Loops; 2]>, words: &[&str]| {
        let error = by(surface, surface, basis).unwrap_err();
        let text = error.to_string();
        assert!(error.code() == 650 && words.iter().all(|word| text.contains(word)), "{text}");
    };
    let surface = torus();
    let loops = basis_of(&surface).loops;
    let swapped = vec![[loops[0].clone(), loops[1].clone()], [loops[1].clone(), loops[0].clone()]];
    refused(&surface, swapped, &["loops 0 and 1", "intersection number 1 on the source and -1"]);
    let open = loops[0][..loops[0].len() - 1].to_vec();
    refused(
        &surface,
        pairs(std::slice::from_ref(&open), std::slice::from_ref(&open)),
        &["loop 0", "not closed on the source"],
    );
    refused(&surface, pairs(&[Vec::new()], &loops[..1]), &["loop 0", "empty on the source"]);
    let double = vec![loops[0].clone(), [&loops[1][..], &loops[1]].concat()];
    refused(&surface, pairs(&double, &double), &["do not generate", "source", "b1"]);
    let ball = super::samples::surface(&shapes::icosphere(3).unwrap());
    let around = ball.mesh().face_halfedges(ricci::mesh::FaceId(0)).to_vec();
    refused(&ball, vec![[around.clone(), around]], &["genus 0"]);
    let surface = double_torus();
    let loops = basis_of(&surface).loops;
    let mut elsewhere = loops.clone();
    let turned =
        elsewhere[1].iter().position(|&h| surface.mesh().origin(h) != surface.mesh().origin(loops[0][0]));
    elsewhere[1].rotate_left(turned.unwrap());
    refused(&surface, pairs(&elsewhere, &loops), &["start at one vertex", "loop 1"]);
    // One loop is conjugated by a loop of the other handle: the homology is the same, but the relator is not fulfilled.
    let mut one = loops.clone();
    one[1] = [&loops[2][..], &loops[1], &back(&loops[2])].concat();
    refused(&surface, pairs(&loops, &one), &["loops"]);
    // The loops bring boundary loops to other ones than the options ask for.
    let surface = holed(2);
    let loops = basis_of(&surface).loops;
    let options = |order: Vec<usize>| MatchOptions {
        basis: pairs(&loops, &loops),
        loops: Some(order),
        ..MatchOptions::default()
    };
    let error = match_surfaces(&surface, &surface, &options(vec![1, 0]), &Control::new()).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("boundary loop 0 of the source to boundary loop 0")
            || text.contains("boundary loop 1 of the source to boundary loop 1"),
        "{text}"
    );
    let kept = match_surfaces(&surface, &surface, &options(vec![0, 1]), &Control::new()).unwrap();
    assert!(apart(&kept, &surface) < 1e-8);
}

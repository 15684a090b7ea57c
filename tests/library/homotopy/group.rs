//! Tests of the word problem, against the group of a regular hyperbolic polygon and against finite groups.

use crate::homotopy::representation::{identity, inverse, times};
use crate::surfaces::Random;
use num_complex::Complex64;
use ricci::Error;
use ricci::topology::{Letter, Reduction, SurfaceGroup, Word};
use std::f64::consts::PI;

fn random_word(group: SurfaceGroup, length: usize, random: &mut Random) -> Word {
    (0..length).map(|_| Letter(random.below(2 * group.n_generators()) as u32)).collect()
}

/// A product of conjugates of the relator and its inverse.
fn random_identity(group: SurfaceGroup, factors: usize, length: usize, random: &mut Random) -> Word {
    let mut word = Word::identity();
    for _ in 0..factors {
        let length = random.below(length + 1);
        let by = random_word(group, length, random);
        let relator = if random.below(2) == 0 { group.relator() } else { group.relator().inverse() };
        word = word.times(&by).times(&relator).times(&by.inverse());
    }
    word
}

fn groups() -> Vec<SurfaceGroup> {
    let sizes = [
        (0, 0),
        (0, 1),
        (0, 2),
        (0, 5),
        (1, 0),
        (1, 1),
        (1, 3),
        (2, 0),
        (2, 1),
        (3, 0),
        (4, 2),
        (7, 0),
        (23, 0),
    ];
    sizes.map(|(genus, boundaries)| SurfaceGroup { genus, boundaries }).to_vec()
}

#[test]
fn conjugates_of_the_relator_reduce_to_the_empty_word() {
    let mut random = Random(11);
    for group in groups().into_iter().filter(|group| group.n_generators() > 0) {
        for round in 0..60 {
            let word = random_identity(group, 1 + round % 7, round, &mut random);
            assert!(group.reduce(&word).is_empty(), "{group:?}: {}", group.text(&word));
            let other = random_word(group, 10, &mut random);
            assert!(group.equal(&other, &word.times(&other)));
            assert!(group.abelianisation(&word).iter().all(|&x| x == 0));
        }
        assert!(group.is_trivial(&random_identity(group, 500, 100, &mut random)), "a long word");
    }
}

/// Matrices (α, β; β̄, ᾱ) of SU(1, 1).
type Matrix = [Complex64; 2];

fn multiply([a, b]: Matrix, [c, d]: Matrix) -> Matrix {
    [a * c + b * d.conj(), a * d + b * c.conj()]
}

fn invert([a, b]: Matrix) -> Matrix {
    [a.conj(), -b]
}

/// The isometry of the disk that maps 0 to p, and the direction of 1 to that from p towards q.
fn frame(p: Complex64, q: Complex64) -> Matrix {
    let scale = (1.0 - p.norm_sqr()).sqrt();
    let towards = (q - p) / (1.0 - p.conj() * q);
    let half = Complex64::from_polar(1.0, 0.5 * towards.arg());
    [half / scale, p * half.conj() / scale]
}

/// The generators a1, b1, … as isometries: side pairings of the regular 4g-gon with angles 2π/4g whose sides, counterclockwise, read a1
/// b1 a1⁻¹ b1⁻¹ …, expressed in the deck transformations that move corner 0 along its sides.
fn polygon_group(genus: usize) -> Vec<Matrix> {
    let n = 4 * genus;
    let cosh_radius = (PI / n as f64).tan().powi(-2);
    let radius = ((cosh_radius - 1.0) / (cosh_radius + 1.0)).sqrt();
    let corner = |k: usize| Complex64::from_polar(radius, 2.0 * PI * (k % n) as f64 / n as f64);
    // The isometry that maps the segment from p to q to that from r to s.
    let carry = |p, q, r, s| multiply(frame(r, s), invert(frame(p, q)));
    let mut generators = Vec::new();
    let mut before = [Complex64::ONE, Complex64::ZERO];
    for i in (0..n).step_by(4) {
        // a⁻¹ runs from corner i + 2 to i + 3 where a runs from i + 1 to i; with P = `before` the
        // transformation from corner 0 to corner i, the pairing of a is P (a b a⁻¹)⁻¹ P⁻¹ and that of b is P
        // a (a b a⁻¹ b⁻¹)⁻¹ P⁻¹.
        let pair_a = carry(corner(i + 3), corner(i + 2), corner(i), corner(i + 1));
        let pair_b = carry(corner(i + 4), corner(i + 3), corner(i + 1), corner(i + 2));
        let local = |m| multiply(multiply(invert(before), m), before);
        let (s, t) = (local(pair_a), local(pair_b));
        let a = multiply(multiply(s, t), invert(s));
        let b = multiply(multiply(invert(a), invert(s)), a);
        generators.extend([a, b]);
        let commutator = multiply(multiply(a, b), multiply(invert(a), invert(b)));
        before = multiply(before, commutator);
    }
    // Seen from corner 0, which they move by one side, their entries are small.
    let to_corner = frame(corner(0), corner(1));
    generators.into_iter().map(|m| multiply(multiply(invert(to_corner), m), to_corner)).collect()
}

#[test]
fn dehns_algorithm_decides_as_the_group_of_the_regular_polygon() {
    let mut random = Random(3);
    for genus in [2, 3] {
        let group = SurfaceGroup { genus, boundaries: 0 };
        let generators = polygon_group(genus);
        // The product, and its largest intermediate entry: rounding grows with the square of it, from the 1e-10 to which the generators
        // are known.
        let matrix = |word: &Word| {
            word.letters().iter().fold(
                ([Complex64::ONE, Complex64::ZERO], 1.0_f64),
                |(product, largest), l| {
                    let image = generators[l.index()];
                    let product = multiply(product, if l.is_inverse() { invert(image) } else { image });
                    (product, largest.max(product[0].norm()))
                },
            )
        };
        let is_one = |[alpha, beta]: Matrix| beta.norm() < 0.1 && (alpha.re.abs() - 1.0).abs() < 0.1;
        assert!(is_one(matrix(&group.relator()).0));
        let (mut trivial, mut decided) = (0, 0);
        for round in 0..4000 {
            // Short words that contain pieces of the relator, so that many are trivial and many nearly are.
            let relator = group.relator();
            let mut word = random_word(group, random.below(3), &mut random);
            for _ in 0..round % 3 {
                let (from, length) = (random.below(4 * genus), random.below(4 * genus + 1));
                let piece: Word = (0..length).map(|k| relator.letters()[(from + k) % (4 * genus)]).collect();
                let piece = if random.below(2) == 0 { piece } else { piece.inverse() };
                word = word.times(&piece);
            }
            let (product, largest) = matrix(&word);
            if largest.powi(2) > 1e7 {
                continue;
            }
            decided += 1;
            // All deck transformations but ±1 have a trace, 2 Re α, well above 2.
            assert_eq!(group.is_trivial(&word), is_one(product), "{}", group.text(&word));
            trivial += usize::from(is_one(product) && !word.is_empty());
            let reduced = group.reduce(&word);
            assert!(reduced.len() <= word.len());
            assert!(is_one(multiply(product, invert(matrix(&reduced).0))), "{}", group.text(&word));
        }
        assert!(decided > 1000, "only {decided} words were short enough");
        assert!(trivial > 20, "only {trivial} trivial words met");
    }
}

#[test]
fn words_with_an_image_in_a_finite_group_are_not_the_identity() {
    let mut random = Random(8);
    let mut nontrivial = 0;
    for group in groups().into_iter().filter(|group| (1..40).contains(&group.n_generators())) {
        // Permutations that satisfy the relator, by repeated random choice.
        let images: Vec<[u8; 4]> = loop {
            let draw = |_| {
                let mut p = identity::<4>();
                (1..4).for_each(|i| p.swap(i, random.below(i + 1)));
                p
            };
            let mut images: Vec<_> = (0..group.n_generators()).map(draw).collect();
            if group.boundaries > 0 {
                let last = images.len() - 1;
                images[last] = identity();
                images[last] = inverse(image(&images, &group.relator()));
            }
            if image(&images, &group.relator()) == identity() {
                break images;
            }
        };
        for length in 0..200 {
            let word = random_word(group, length, &mut random);
            assert_eq!(image(&images, &word), image(&images, &group.reduce(&word)), "{}", group.text(&word));
            if image(&images, &word) != identity() {
                assert!(!group.is_trivial(&word));
                nontrivial += 1;
            }
        }
    }
    assert!(nontrivial > 1000);
}

fn image(images: &[[u8; 4]], word: &Word) -> [u8; 4] {
    let letter = |l: &Letter| if l.is_inverse() { inverse(images[l.index()]) } else { images[l.index()] };
    word.letters().iter().map(letter).fold(identity(), times)
}

#[test]
fn normal_forms_of_tori_and_open_surfaces_depend_on_the_element_alone() {
    let mut random = Random(21);
    for group in groups().into_iter().filter(|g| g.n_generators() > 0 && (g.genus == 1 || g.boundaries > 0)) {
        for length in 0..60 {
            let word = random_word(group, length, &mut random);
            let trivial = random_identity(group, 3, 5, &mut random);
            let (front, back) = word.letters().split_at(word.len() / 2);
            let other =
                Word::from_iter(front.iter().copied()).times(&trivial).times(&back.iter().copied().collect());
            assert_eq!(group.reduce(&word), group.reduce(&other));
        }
    }
}

#[test]
fn a_reduction_is_that_of_the_letters_pushed() {
    let mut random = Random(2);
    for group in groups().into_iter().filter(|group| group.n_generators() > 0) {
        let (mut reduction, mut word) = (Reduction::new(group), Word::identity());
        for _ in 0..100 {
            let letter = Letter(random.below(2 * group.n_generators()) as u32);
            reduction.push(letter);
            word.push(letter);
            assert!(group.equal(&reduction.word(), &word));
            assert_eq!(reduction.word().is_empty(), group.is_trivial(&word));
        }
    }
}

#[test]
fn abelianisation_is_a_homomorphism_that_kills_the_relator() {
    let mut random = Random(9);
    for group in groups() {
        assert!(group.abelianisation(&group.relator()).iter().all(|&x| x == 0));
        let rank = 2 * group.genus + group.boundaries.saturating_sub(1);
        assert_eq!(group.abelianisation(&Word::identity()).len(), rank);
        if group.n_generators() > 0 {
            let [u, v] = [30, 40].map(|n| random_word(group, n, &mut random));
            let [x, y, xy] = [&u, &v, &u.times(&v)].map(|w| group.abelianisation(w));
            assert!((0..rank).all(|k| x[k] + y[k] == xy[k]));
            assert_eq!(group.abelianisation(&group.reduce(&u)), x);
        }
    }
}

#[test]
fn text_and_words_translate_into_each_other() {
    let group = SurfaceGroup { genus: 2, boundaries: 1 };
    assert_eq!(group.names(), ["a1", "b1", "a2", "b2", "c1"]);
    assert_eq!(group.text(&group.relator()), "a1 b1 a1^-1 b1^-1 a2 b2 a2^-1 b2^-1 c1");
    let mut random = Random(4);
    for group in groups().into_iter().filter(|group| group.n_generators() > 0) {
        for length in 0..30 {
            let word = random_word(group, length, &mut random);
            assert_eq!(group.parse(&group.text(&word)).unwrap(), word);
        }
    }
    assert_eq!(group.parse(" 1 ").unwrap(), Word::identity());
    assert_eq!(group.parse("a1 b2 b2^-1 a1^-1").unwrap(), Word::identity());
    for wrong in ["a3", "a0", "c2", "d1", "a", "a1^2", "a01", "a+1", "é1", "^-1", "a99999999999999999999"] {
        assert!(
            matches!(group.parse(wrong), Err(Error::Argument { value, .. }) if value == wrong),
            "{wrong}"
        );
    }
}

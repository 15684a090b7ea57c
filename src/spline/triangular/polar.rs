//! Polynomials of two variables and their polar forms.

use super::index::MAX_DEGREE;

/// A polynomial of degree at most n with values in R^D: the sum of `coefficients[(p, q)] x^p y^q`, p + q ≤ n.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial<const D: usize> {
    degree: usize,
    /// The coefficients in the order 1, x, y, x², xy, y², …
    coefficients: Vec<[f64; D]>,
}

/// The monomials x^p y^q of degree at most n as (p, q): 1, x, y, x², xy, y², …
pub fn monomials(degree: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=degree).flat_map(|total| (0..=total).map(move |q| (total - q, q)))
}

impl<const D: usize> Polynomial<D> {
    /// The polynomial with given coefficients in the order of [`monomials`].
    ///
    /// # Panics
    /// If there are not (n + 1)(n + 2)/2 of them, or n is above [`MAX_DEGREE`].
    pub fn new(degree: usize, coefficients: Vec<[f64; D]>) -> Polynomial<D> {
        assert!(degree <= MAX_DEGREE && coefficients.len() == monomials(degree).count());
        Polynomial { degree, coefficients }
    }

    /// The degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The value at a point.
    pub fn value(&self, u: [f64; 2]) -> [f64; D] {
        self.polar(&[u; MAX_DEGREE][..self.degree])
    }

    /// The polar form: symmetric, affine in each of its n arguments, and equal to the polynomial if all arguments are equal \[Sei91\].
    ///
    /// # Panics
    /// If there are not n arguments.
    pub fn polar(&self, arguments: &[[f64; 2]]) -> [f64; D] {
        let n = self.degree;
        assert_eq!(arguments.len(), n, "a polar form has as many arguments as the degree");
        // e[p][q] is the sum, over all choices of p arguments and q other ones, of the product of the x of the former and the y of the
        // latter.
        let mut e = [[0.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
        e[0][0] = 1.0;
        for (count, &[x, y]) in arguments.iter().enumerate() {
            for p in (0..=count + 1).rev() {
                for q in (0..=count + 1 - p).rev() {
                    let by_x = if p > 0 { x * e[p - 1][q] } else { 0.0 };
                    let by_y = if q > 0 { y * e[p][q - 1] } else { 0.0 };
                    e[p][q] += by_x + by_y;
                }
            }
        }
        let mut sum = [0.0; D];
        for ((p, q), c) in monomials(n).zip(&self.coefficients) {
            let choices = factorial(n) / (factorial(p) * factorial(q) * factorial(n - p - q));
            let weight = e[p][q] / choices;
            sum.iter_mut().zip(c).for_each(|(sum, c)| *sum += weight * c);
        }
        sum
    }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

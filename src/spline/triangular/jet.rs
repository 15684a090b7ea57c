//! Jets of functions of two variables: value and derivatives up to the second at a point, with their arithmetic.

use crate::geometry::complex::Complex;

/// A jet: value, ∂x, ∂y, ∂xx, ∂xy, ∂yy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jet(pub [f64; 6]);

impl Jet {
    /// The jet of a constant.
    pub fn constant(x: f64) -> Jet {
        Jet([x, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    /// The jets of real and imaginary part of a holomorphic function of x + iy with a given value, first and second derivative.
    pub fn of_holomorphic([value, first, second]: [Complex; 3]) -> [Jet; 2] {
        let ([a, b], [c, d]) = (first, second);
        [Jet([value[0], a, -b, c, -d, -c]), Jet([value[1], b, a, d, c, -d])]
    }

    pub fn plus(self, other: Jet) -> Jet {
        Jet(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    pub fn times(self, other: Jet) -> Jet {
        let ([a, ax, ay, axx, axy, ayy], [b, bx, by, bxx, bxy, byy]) = (self.0, other.0);
        Jet([
            a * b,
            ax * b + a * bx,
            ay * b + a * by,
            axx * b + 2.0 * ax * bx + a * bxx,
            axy * b + ax * by + ay * bx + a * bxy,
            ayy * b + 2.0 * ay * by + a * byy,
        ])
    }

    /// The jet of f(p, q), for f with these value and derivatives f_p, f_q, f_pp, f_pq, f_qq.
    pub fn of_two([f, fp, fq, fpp, fpq, fqq]: [f64; 6], [p, q]: [Jet; 2]) -> Jet {
        let ([_, px, py, pxx, pxy, pyy], [_, qx, qy, qxx, qxy, qyy]) = (p.0, q.0);
        let second = |a: [f64; 2], b: [f64; 2], ab: [f64; 2]| {
            fpp * a[0] * b[0]
                + fpq * (a[0] * b[1] + a[1] * b[0])
                + fqq * a[1] * b[1]
                + fp * ab[0]
                + fq * ab[1]
        };
        let (x, y) = ([px, qx], [py, qy]);
        Jet([
            f,
            fp * px + fq * qx,
            fp * py + fq * qy,
            second(x, x, [pxx, qxx]),
            second(x, y, [pxy, qxy]),
            second(y, y, [pyy, qyy]),
        ])
    }

    /// The jet of f of this function, for f with a given value, first and second derivative.
    pub fn through(self, [value, first, second]: [f64; 3]) -> Jet {
        let [_, x, y, xx, xy, yy] = self.0;
        let of = |a: f64, b: f64, ab: f64| second * a * b + first * ab;
        Jet([value, first * x, first * y, of(x, x, xx), of(x, y, xy), of(y, y, yy)])
    }
}

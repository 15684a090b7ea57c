//! Energies of a linear map of the plane that depend on its singular values alone, with their first two derivatives.
//!
//! With `F = U diag(σ, τ) Vᵀ` the Hessian of such an energy e(σ, τ) has the eigenvectors `U N Vᵀ`: two combinations of `diag(1, 0)` and
//! `diag(0, 1)`, whose eigenvalues are those of the Hessian of e; the turn `[[0, −1], [1, 0]]/√2` with `(e_σ + e_τ)/(σ + τ)`; and the shear
//! `[[0, 1], [1, 0]]/√2` with `(e_σ − e_τ)/(σ − τ)` [SGK19, Section 4]. The quotients are written out here, so that nothing cancels where
//! σ = τ.

/// The parts of an energy; a map that keeps lengths has Σ shares · 4, less 4 for the share of `arap`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct EnergyShares {
    /// Of σ² + τ² + σ⁻² + τ⁻².
    pub isometric: f64,
    /// Of 2 (σ/τ + τ/σ).
    pub conformal: f64,
    /// Of 2 (στ + 1/(στ)).
    pub area: f64,
    /// Of (σ − 1)² + (τ − 1)².
    pub arap: f64,
}

/// An energy's derivatives in the singular values, and the two eigenvalues that do not come from them alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EnergySlopes {
    /// e_σ and e_τ.
    pub slope: [f64; 2],
    /// e_σσ, e_στ, e_ττ.
    pub second: [f64; 3],
    /// (e_σ + e_τ)/(σ + τ).
    pub turn: f64,
    /// (e_σ − e_τ)/(σ − τ).
    pub shear: f64,
}

impl EnergyShares {
    /// True if the energy is the same for all sizes of a map.
    pub fn is_of_shape_alone(&self) -> bool {
        self.isometric == 0.0 && self.area == 0.0 && self.arap == 0.0
    }

    /// The energy, from ‖F‖² and det F; infinite unless the determinant is positive.
    pub fn value(&self, square: f64, det: f64) -> f64 {
        if det.is_nan() || det <= 0.0 {
            return f64::INFINITY;
        }
        let mut value = 0.0;
        if self.isometric != 0.0 {
            value += self.isometric * square * (1.0 + 1.0 / (det * det));
        }
        if self.conformal != 0.0 {
            value += 2.0 * self.conformal * square / det;
        }
        if self.area != 0.0 {
            value += 2.0 * self.area * (det + 1.0 / det);
        }
        if self.arap != 0.0 {
            value += self.arap * (square - 2.0 * (square + 2.0 * det).sqrt() + 2.0);
        }
        value
    }

    /// The derivatives of the energy without `arap` as a function of the square q = ‖F‖² and a positive determinant j: in q, in j, in both,
    /// twice in j. It is linear in q.
    pub fn slopes_in_square_and_det(&self, q: f64, j: f64) -> [f64; 4] {
        let (square, cube) = (j * j, j * j * j);
        let EnergyShares { isometric, conformal, area, .. } = *self;
        [
            isometric * (1.0 + 1.0 / square) + 2.0 * conformal / j,
            -2.0 * isometric * q / cube - 2.0 * conformal * q / square + 2.0 * area * (1.0 - 1.0 / square),
            -2.0 * isometric / cube - 2.0 * conformal / square,
            6.0 * isometric * q / (square * square) + 4.0 * conformal * q / cube + 4.0 * area / cube,
        ]
    }

    /// The derivatives at positive singular values.
    pub fn slopes(&self, [s, t]: [f64; 2]) -> EnergySlopes {
        let mut all = EnergySlopes { slope: [0.0; 2], second: [0.0; 3], turn: 0.0, shear: 0.0 };
        for (share, part) in [
            (self.isometric, isometric as fn(f64, f64) -> EnergySlopes),
            (2.0 * self.conformal, conformal),
            (2.0 * self.area, area),
            (self.arap, arap),
        ] {
            if share != 0.0 {
                all = all.plus(share, &part(s, t));
            }
        }
        all
    }
}

impl EnergySlopes {
    fn plus(self, share: f64, part: &EnergySlopes) -> EnergySlopes {
        EnergySlopes {
            slope: std::array::from_fn(|k| self.slope[k] + share * part.slope[k]),
            second: std::array::from_fn(|k| self.second[k] + share * part.second[k]),
            turn: self.turn + share * part.turn,
            shear: self.shear + share * part.shear,
        }
    }
}

/// Of σ² + τ² + σ⁻² + τ⁻².
fn isometric(s: f64, t: f64) -> EnergySlopes {
    let det = s * t;
    let cube = det * det * det;
    EnergySlopes {
        slope: [s, t].map(|x| 2.0 * (x - 1.0 / (x * x * x))),
        second: [2.0 + 6.0 / s.powi(4), 0.0, 2.0 + 6.0 / t.powi(4)],
        turn: 2.0 - 2.0 * (s * s - s * t + t * t) / cube,
        shear: 2.0 + 2.0 * (s * s + s * t + t * t) / cube,
    }
}

/// Of σ/τ + τ/σ.
fn conformal(s: f64, t: f64) -> EnergySlopes {
    let det = s * t;
    let square = det * det;
    EnergySlopes {
        slope: [1.0 / t - t / (s * s), 1.0 / s - s / (t * t)],
        second: [2.0 * t / (s * s * s), -1.0 / (s * s) - 1.0 / (t * t), 2.0 * s / (t * t * t)],
        turn: 1.0 / det - (s * s - s * t + t * t) / square,
        shear: 1.0 / det + (s * s + s * t + t * t) / square,
    }
}

/// Of στ + 1/(στ).
fn area(s: f64, t: f64) -> EnergySlopes {
    let det = s * t;
    let square = det * det;
    let turn = 1.0 - 1.0 / square;
    EnergySlopes {
        slope: [t * turn, s * turn],
        second: [2.0 * t * t / (det * square), 1.0 + 1.0 / square, 2.0 * s * s / (det * square)],
        turn,
        shear: -turn,
    }
}

/// Of (σ − 1)² + (τ − 1)².
fn arap(s: f64, t: f64) -> EnergySlopes {
    EnergySlopes {
        slope: [2.0 * (s - 1.0), 2.0 * (t - 1.0)],
        second: [2.0, 0.0, 2.0],
        turn: 2.0 - 4.0 / (s + t),
        shear: 2.0,
    }
}

//! Whole vectors of the grid of a seamless map, rotations by multiples of 90° with translations, and exact predicates on them.

/// A point or vector in units of the grid, below 2^54 in absolute value.
pub(super) type GridPoint = [i64; 2];

/// A direction along an axis: that many quarter turns from +x.
pub(super) type Axis = u8;

/// A vector turned counterclockwise by k quarter turns.
pub(super) fn turned([x, y]: GridPoint, k: Axis) -> GridPoint {
    match k % 4 {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}

pub(super) fn minus(a: GridPoint, b: GridPoint) -> GridPoint {
    [a[0] - b[0], a[1] - b[1]]
}

/// The unit vector of a direction.
pub(super) fn unit(axis: Axis) -> GridPoint {
    turned([1, 0], axis)
}

pub(super) fn opposite(axis: Axis) -> Axis {
    (axis + 2) % 4
}

/// The product of a × b, exact.
pub(super) fn cross(a: GridPoint, b: GridPoint) -> i128 {
    i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
}

/// The scalar product, exact.
pub(super) fn dot(a: GridPoint, b: GridPoint) -> i128 {
    i128::from(a[0]) * i128::from(b[0]) + i128::from(a[1]) * i128::from(b[1])
}

/// Twice the signed area of a triangle.
pub(super) fn doubled_area(a: GridPoint, b: GridPoint, c: GridPoint) -> i128 {
    cross(minus(b, a), minus(c, a))
}

/// A rotation by a multiple of 90° and a translation after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct GridMotion {
    /// Quarter turns.
    pub turns: Axis,
    /// The translation.
    pub shift: GridPoint,
}

impl GridMotion {
    pub const IDENTITY: GridMotion = GridMotion { turns: 0, shift: [0, 0] };

    /// The motion that carries a point to the origin and a direction to +x.
    pub fn to_origin(point: GridPoint, axis: Axis) -> GridMotion {
        let turns = (4 - axis % 4) % 4;
        let [x, y] = turned(point, turns);
        GridMotion { turns, shift: [-x, -y] }
    }

    /// The motion that carries one directed segment to another of the same length, if they differ by a multiple of 90°.
    pub fn between(from: [GridPoint; 2], to: [GridPoint; 2]) -> Option<GridMotion> {
        let [v, w] = [minus(from[1], from[0]), minus(to[1], to[0])];
        let turns = (0..4).find(|&k| turned(v, k) == w)?;
        Some(GridMotion { turns, shift: minus(to[0], turned(from[0], turns)) })
    }

    pub fn apply(&self, point: GridPoint) -> GridPoint {
        let [x, y] = turned(point, self.turns);
        [x + self.shift[0], y + self.shift[1]]
    }

    pub fn turn(&self, axis: Axis) -> Axis {
        (axis + self.turns) % 4
    }

    pub fn inverse(&self) -> GridMotion {
        let turns = (4 - self.turns) % 4;
        let [x, y] = turned(self.shift, turns);
        GridMotion { turns, shift: [-x, -y] }
    }

    /// This motion after another.
    pub fn after(&self, first: &GridMotion) -> GridMotion {
        GridMotion { turns: (self.turns + first.turns) % 4, shift: self.apply(first.shift) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_carry_segments_to_segments() {
        for turns in 0..4 {
            let motion = GridMotion { turns, shift: [5, -7] };
            let segment = [[3, 4], [10, -2]];
            let image = segment.map(|p| motion.apply(p));
            assert_eq!(GridMotion::between(segment, image), Some(motion));
            let there_and_back = GridMotion::between(image, segment).map(|back| back.after(&motion));
            assert_eq!(there_and_back, Some(GridMotion::IDENTITY));
            assert_eq!(motion.inverse().after(&motion), GridMotion::IDENTITY);
            assert_eq!(GridMotion::to_origin([3, 4], turns).apply([3, 4]), [0, 0]);
            assert_eq!(GridMotion::to_origin([3, 4], turns).turn(turns), 0);
        }
    }
}

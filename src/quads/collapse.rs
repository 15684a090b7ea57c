//! Quads two of whose sides are the same edge, as around a cone of valence 1, are collapsed: the edge between the other two sides closes.

/// The quads of a mesh whose vertices may still lie in quads that are no quadrilaterals.
pub(super) struct RawQuads {
    pub quads: Vec<[u32; 4]>,
    pub rectangle: Vec<u32>,
    pub creases: Vec<[u32; 2]>,
    /// Per vertex true on the boundary: two sides of a quad with the same ends then are two edges, around a hole.
    pub is_border: Vec<bool>,
}

impl RawQuads {
    /// Takes away quads (a, b, c, b) with a vertex a that is in no other, until there is none; returns the places of the vertices that are left
    /// and the number of quads that are gone.
    pub fn collapse_single_corners<P: Copy>(&mut self, places: Vec<P>) -> (Vec<P>, usize) {
        let before = self.quads.len();
        let mut valence = vec![0; places.len()];
        self.quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        loop {
            let single = |quad: &[u32; 4]| {
                let is_single =
                    |i: usize| quad[(i + 3) % 4] == quad[(i + 1) % 4] && valence[quad[i] as usize] == 1;
                (0..4).any(|i| is_single(i) && !self.is_border[quad[i] as usize])
            };
            let gone: Vec<bool> = self.quads.iter().map(single).collect();
            if !gone.contains(&true) {
                break;
            }
            for (quad, _) in self.quads.iter().zip(&gone).filter(|(_, gone)| **gone) {
                quad.iter().for_each(|&v| valence[v as usize] -= 1);
            }
            let keep = |k: &mut usize| {
                *k += 1;
                !gone[*k - 1]
            };
            let (mut i, mut j) = (0, 0);
            self.quads.retain(|_| keep(&mut i));
            self.rectangle.retain(|_| keep(&mut j));
        }
        let mut number = vec![u32::MAX; places.len()];
        let mut left = Vec::new();
        for (v, place) in places.into_iter().enumerate().filter(|(v, _)| valence[*v] > 0) {
            number[v] = left.len() as u32;
            left.push(place);
        }
        self.quads.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
        self.creases.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
        self.creases.retain(|ends| !ends.contains(&u32::MAX));
        (left, before - self.quads.len())
    }
}

#[cfg(test)]
mod tests {
    use super::RawQuads;

    #[test]
    fn a_quad_around_a_vertex_of_valence_1_goes() {
        // The quad (0, 1, 2, 1) closes the gap between two others at the edge 1–2.
        let quads = vec![[0, 1, 2, 1], [2, 1, 3, 4], [1, 2, 5, 6]];
        let mut raw = RawQuads {
            quads,
            rectangle: vec![0, 1, 2],
            creases: vec![[0, 1], [3, 4]],
            is_border: vec![false; 7],
        };
        let (places, gone) = raw.collapse_single_corners((0..7).collect());
        assert_eq!((gone, places), (1, vec![1, 2, 3, 4, 5, 6]));
        assert_eq!(raw.quads, [[1, 0, 2, 3], [0, 1, 4, 5]]);
        assert_eq!((raw.rectangle, raw.creases), (vec![1, 2], vec![[2, 3]]));
    }
}

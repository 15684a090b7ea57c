//! Texels as bits: those that a chart touches, and where such a mask is free of a page's.

/// Rows of bits, bit x of a row in word x / 64.
#[derive(Debug, Clone)]
pub(super) struct TexelMask {
    pub width: usize,
    pub height: usize,
    words: usize,
    bits: Vec<u64>,
}

impl TexelMask {
    pub fn new(width: usize, height: usize) -> TexelMask {
        let words = width.div_ceil(64);
        TexelMask { width, height, words, bits: vec![0; words * height] }
    }

    fn row(&self, y: usize) -> &[u64] {
        &self.bits[y * self.words..(y + 1) * self.words]
    }

    /// The number of bits that are set.
    pub fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Sets the bits from `from` to `to`, both included, of a row.
    fn set(&mut self, y: usize, from: usize, to: usize) {
        let row = &mut self.bits[y * self.words..(y + 1) * self.words];
        for (k, word) in row.iter_mut().enumerate().take(to / 64 + 1).skip(from / 64) {
            let low = from.saturating_sub(64 * k).min(64);
            let high = (to + 1 - 64 * k).min(64);
            let below = |n: usize| if n == 64 { u64::MAX } else { (1u64 << n) - 1 };
            *word |= below(high) & !below(low);
        }
    }

    /// Sets every texel that the triangle touches; its corners lie inside the mask.
    pub fn cover(&mut self, corners: [[f64; 2]; 3]) {
        let ys = corners.map(|p| p[1]);
        let low = ys.iter().copied().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
        let high = ys.iter().copied().fold(f64::NEG_INFINITY, f64::max).floor().max(0.0) as usize;
        for y in low..=high.min(self.height - 1) {
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for k in 0..3 {
                if let Some([a, b]) = within_row([corners[k], corners[(k + 1) % 3]], y as f64) {
                    (left, right) = (left.min(a.min(b)), right.max(a.max(b)));
                }
            }
            if left <= right {
                let last = self.width - 1;
                self.set(
                    y,
                    (left.floor().max(0.0) as usize).min(last),
                    (right.floor().max(0.0) as usize).min(last),
                );
            }
        }
    }

    /// The mask grown by a number of texels to all sides, so that it is twice as many wider and higher.
    pub fn grown(&self, by: usize) -> TexelMask {
        let mut grown = TexelMask::new(self.width + 2 * by, self.height + 2 * by);
        for y in 0..self.height {
            for [from, to] in self.runs(y) {
                for row in y..=y + 2 * by {
                    grown.set(row, from, to + 2 * by);
                }
            }
        }
        grown
    }

    /// The runs of set bits of a row, as their first and last bits.
    pub fn runs(&self, y: usize) -> Vec<[usize; 2]> {
        let (row, mut found) = (self.row(y), Vec::new());
        let is_set = |x: usize| row[x / 64] >> (x % 64) & 1 == 1;
        let mut x = 0;
        while x < self.width {
            let rest = row[x / 64] >> (x % 64);
            if rest == 0 {
                x = 64 * (x / 64 + 1);
                continue;
            }
            x += rest.trailing_zeros() as usize;
            let from = x;
            while x < self.width && is_set(x) {
                let ones = (!(row[x / 64] >> (x % 64))).trailing_zeros() as usize;
                x += ones.min(64 - x % 64).max(1);
            }
            found.push([from, x.min(self.width) - 1]);
        }
        found
    }

    /// Sets the bits of a mask whose first bit lies at (x, y).
    pub fn add(&mut self, mask: &TexelMask, [x, y]: [usize; 2]) {
        for row in 0..mask.height {
            for [from, to] in mask.runs(row) {
                self.set(y + row, x + from, x + to);
            }
        }
    }

    /// The rows with set bits and their runs, far ones before those between them: a mask that meets another one does so in the first few.
    pub fn spread_rows(&self) -> Vec<MaskRow> {
        let mut rows: Vec<MaskRow> = (0..self.height).map(|y| MaskRow { y, runs: self.runs(y) }).collect();
        rows.retain(|row| !row.runs.is_empty());
        rows.sort_by_key(|row| (std::cmp::Reverse((row.y + 1).trailing_zeros()), row.y));
        let longest = |row: &MaskRow| row.runs.iter().map(|[from, to]| to - from).max();
        if let Some(widest) = (0..rows.len()).max_by_key(|&k| (longest(&rows[k]), std::cmp::Reverse(k))) {
            rows.swap(0, widest);
        }
        rows
    }

    /// The least of the `n` first x at which a mask, given by its rows, does not meet this one with its first bit at (x, y); none if it
    /// does at all of them.
    pub fn free_place(&self, rows: &[MaskRow], y: usize, n: usize) -> Option<usize> {
        let words = n.div_ceil(64);
        let mut taken = vec![0u64; words];
        if !n.is_multiple_of(64) {
            taken[words - 1] = u64::MAX << (n % 64);
        }
        let mut spread = vec![0u64; self.words];
        for row in rows {
            let own = self.row(y + row.y);
            if own.iter().all(|word| *word == 0) {
                continue;
            }
            for [from, to] in &row.runs {
                spread.copy_from_slice(own);
                spread_down(&mut spread, to - from + 1);
                or_shifted(&mut taken, &spread, *from);
            }
            if taken.iter().all(|word| *word == u64::MAX) {
                return None;
            }
        }
        let first = taken.iter().position(|word| *word != u64::MAX)?;
        Some(64 * first + (!taken[first]).trailing_zeros() as usize)
    }
}

/// A row of a mask: its number and the first and last bits of its runs.
pub(super) struct MaskRow {
    pub y: usize,
    pub runs: Vec<[usize; 2]>,
}

/// The least and the largest x of a segment between y and y + 1; none if it is not there.
fn within_row([p, q]: [[f64; 2]; 2], y: f64) -> Option<[f64; 2]> {
    let ([a, b], top) = (if p[1] <= q[1] { [p, q] } else { [q, p] }, y + 1.0);
    if b[1] < y || a[1] > top {
        return None;
    }
    let at = |level: f64| {
        let t = ((level - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0);
        a[0] + t * (b[0] - a[0])
    };
    let first = if a[1] < y { at(y) } else { a[0] };
    let last = if b[1] > top { at(top) } else { b[0] };
    Some([first, last])
}

/// Bit x becomes the union of the bits from x to x + n − 1.
fn spread_down(bits: &mut [u64], n: usize) {
    let mut done = 1;
    while done < n {
        let by = done.min(n - done);
        or_self_shifted(bits, by);
        done += by;
    }
}

fn or_self_shifted(bits: &mut [u64], by: usize) {
    let (skip, shift) = (by / 64, by % 64);
    for k in 0..bits.len() {
        let word = |i: usize| bits.get(i).copied().unwrap_or(0);
        let low = word(k + skip) >> shift;
        let high = if shift == 0 { 0 } else { word(k + skip + 1) << (64 - shift) };
        bits[k] |= low | high;
    }
}

fn or_shifted(into: &mut [u64], bits: &[u64], by: usize) {
    let (skip, shift) = (by / 64, by % 64);
    for (k, word) in into.iter_mut().enumerate() {
        let of = |i: usize| bits.get(i).copied().unwrap_or(0);
        let high = if shift == 0 { 0 } else { of(k + skip + 1) << (64 - shift) };
        *word |= of(k + skip) >> shift | high;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_covers_the_texels_that_it_touches() {
        let mut mask = TexelMask::new(130, 4);
        mask.cover([[0.5, 0.5], [128.5, 0.5], [0.5, 2.5]]);
        assert_eq!(mask.runs(0), [[0, 128]]);
        assert_eq!(mask.runs(1), [[0, 96]]);
        assert_eq!((mask.runs(2), mask.runs(3)), (vec![[0, 32]], vec![]));
    }

    #[test]
    fn a_mask_lies_in_the_hole_of_another() {
        let mut page = TexelMask::new(200, 20);
        for y in 0..20 {
            page.set(y, 0, 99);
            page.set(y, 110, 199);
        }
        page.set(4, 105, 105);
        let place = |width: usize, height: usize| {
            let mut mask = TexelMask::new(width, height);
            (0..height).for_each(|y| mask.set(y, 0, width - 1));
            let rows = mask.spread_rows();
            (0..=20 - height).find_map(|y| page.free_place(&rows, y, 201 - width).map(|x| [x, y]))
        };
        assert_eq!([place(10, 3), place(10, 5), place(11, 2)], [Some([100, 0]), Some([100, 5]), None]);
    }

    #[test]
    fn a_grown_mask_keeps_its_distance() {
        let mut mask = TexelMask::new(70, 1);
        mask.set(0, 63, 64);
        let grown = mask.grown(2);
        assert_eq!((grown.width, grown.height), (74, 5));
        assert!((0..5).all(|y| grown.runs(y) == [[63, 68]]));
    }
}

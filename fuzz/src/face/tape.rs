//! The bytes of a fuzzer's input as numbers, arrays and texts. At the end of the bytes all are zero.

/// Entries of an array that is given: more than any call reads, whose counts [`Tape::count`] draws.
const ENTRIES: usize = 4096;
/// Entries of an array that are drawn: three for each row that a count names. They come again and again.
const DRAWN: usize = 12 * MOST_ROWS;
/// Largest count of entries or rows.
pub const MOST_ROWS: usize = 64;

/// The input, and whether something was drawn from it that is no ordinary number.
pub struct Tape<'a> {
    rest: &'a [u8],
    /// Numbers that are not finite, or beyond 1e100, were drawn since this was set to false.
    pub wild: bool,
}

const WILD: [f64; 6] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e300, f64::MAX];
const NUMBERS: [f64; 14] =
    [0.0, 1.0, 0.5, 2.0, 0.1, 3.0, -1.0, 0.05, 5.0, -0.0, 1.5, std::f64::consts::PI, 1e-300, -2.5];

impl<'a> Tape<'a> {
    pub fn new(bytes: &'a [u8]) -> Tape<'a> {
        Tape { rest: bytes, wild: false }
    }

    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.rest.split_first() else { return 0 };
        self.rest = rest;
        first
    }

    /// One of so many.
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n.max(1)
    }

    /// Once in `n` times.
    pub fn one_in(&mut self, n: u8) -> bool {
        self.byte() % n == n - 1
    }

    pub fn double(&mut self) -> f64 {
        let b = self.byte();
        if b >= 240 {
            self.wild = true;
            return WILD[usize::from(b) % WILD.len()];
        }
        NUMBERS[usize::from(b) % NUMBERS.len()]
    }

    /// A small number, sometimes none that counts anything.
    pub fn number(&mut self) -> u32 {
        match self.byte() {
            255 => u32::MAX,
            254 => 1 << 31,
            b => u32::from(b) % 13,
        }
    }

    /// A number of entries or rows; `needed` is what an earlier call asked for.
    pub fn count(&mut self, needed: usize) -> usize {
        match self.byte() {
            b if b >= 160 => needed.min(4 * MOST_ROWS),
            b => usize::from(b) % (MOST_ROWS + 1),
        }
    }

    fn mixed(seed: &mut u64) -> u64 {
        *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (*seed ^ (*seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 11
    }

    /// The bytes of an array of the words that are drawn, repeated.
    fn repeated<const N: usize>(drawn: impl IntoIterator<Item = [u8; N]>) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(N * (ENTRIES + DRAWN));
        drawn.into_iter().for_each(|word| bytes.extend(word));
        let once = bytes.len();
        while bytes.len() < N * ENTRIES {
            bytes.extend_from_within(..once);
        }
        bytes
    }

    fn doubles(&mut self) -> Vec<f64> {
        let (style, mut seed) = (self.byte() % 8, u64::from(self.byte()));
        let mut unit = move || Tape::mixed(&mut seed) as f64 / (1_u64 << 53) as f64;
        match style {
            0 => vec![1.0; DRAWN],
            1 => vec![0.0; DRAWN],
            2 => (0..DRAWN).map(|i| 0.1 * i as f64).collect(),
            3 => (0..DRAWN).map(|_| unit()).collect(),
            4 => (0..DRAWN).map(|_| 20.0 * unit() - 10.0).collect(),
            5 => (0..DRAWN).map(|i| [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0][i % 8]).collect(),
            6 => (0..DRAWN).map(|i| if i < 24 { self.double() } else { 0.25 }).collect(),
            _ => (0..DRAWN).map(|_| (8.0 * unit()).floor()).collect(),
        }
    }

    fn integers(&mut self) -> Vec<i64> {
        let (style, mut seed) = (self.byte() % 8, u64::from(self.byte()));
        let mut draw = move |n: u64| (Tape::mixed(&mut seed) % n) as i64;
        match style {
            0 => (0..DRAWN as i64).collect(),
            1 => vec![0; DRAWN],
            2 => (0..DRAWN).map(|_| draw(8)).collect(),
            3 => (0..DRAWN).map(|_| draw(64)).collect(),
            4 => (0..DRAWN as i64).map(|i| i + 1).collect(),
            5 => (0..DRAWN).map(|_| draw(9) - 4).collect(),
            6 => (0..DRAWN).map(|i| if i < 24 { i64::from(self.byte() as i8) } else { 1 }).collect(),
            _ => (0..DRAWN).map(|_| [i64::MAX, 0, 1, i64::from(i32::MIN), -1][draw(5) as usize]).collect(),
        }
    }

    /// The bytes of an array of these words; offsets and sizes of rows, which say how much of other arrays is read, are small.
    pub fn array(&mut self, word: &str, name: &str) -> Vec<u8> {
        match word {
            "double" => Tape::repeated(self.doubles().into_iter().map(f64::to_ne_bytes)),
            "size_t" => {
                let step = self.byte() % 8;
                let offsets = self.integers().into_iter().enumerate().map(|(i, n)| match step {
                    0 => n.rem_euclid(MOST_ROWS as i64) as usize,
                    step => (i * usize::from(step)).min(MOST_ROWS),
                });
                Tape::repeated(offsets.map(usize::to_ne_bytes))
            }
            "uint8_t" | "char" => Tape::repeated((0..MOST_ROWS).map(|_| [self.byte()])),
            _ if name.ends_with("_sizes") => {
                Tape::repeated(self.integers().into_iter().map(|n| (n.rem_euclid(8) as u32).to_ne_bytes()))
            }
            _ => Tape::repeated(self.integers().into_iter().map(|n| (n as u32).to_ne_bytes())),
        }
    }

    /// Some of the bytes that follow.
    pub fn bytes(&mut self) -> Vec<u8> {
        let n = usize::from(self.byte()).min(self.rest.len());
        let (text, rest) = self.rest.split_at(n);
        self.rest = rest;
        text.to_vec()
    }
}

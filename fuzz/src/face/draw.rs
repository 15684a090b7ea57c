//! Arguments of calls, drawn from the input: valid ones, NULL, wrong sizes, meaningless numbers.

use super::session::Session;
use super::tape::MOST_ROWS;
use super::{Kind, Struct, layouts, word};
use std::ffi::{CString, c_char, c_void};
use std::path::PathBuf;
use std::sync::OnceLock;

/// Entries that a buffer has room for.
const CAPACITY: usize = 1024;
/// Entries of arrays and of buffers whose number is not given: more than any handle here has.
const UNCOUNTED: usize = 4096;
/// The byte that fills a buffer before a call.
pub const UNTOUCHED: u8 = 0xa5;
/// Options whose defaults are seconds of work: all of their fields are drawn.
const LONG: [&str; 2] = ["ricci_spline_surface_options", "ricci_bicubic_options"];
/// Bytes of the largest struct, and some more.
const STRUCT_BYTES: usize = 4096;

/// Memory that a call may write, which is examined when it has returned.
pub enum Watched {
    /// Entries of a type in memory that the session keeps, from an offset; the capacity that the call was told.
    Buffer { kept: usize, at: usize, word: &'static str, bytes: usize, capacity: Option<usize> },
    /// A struct, and the size that the call was told.
    Struct { kept: usize, of: &'static Struct, size: usize },
    /// The place for a handle.
    Made { kept: usize, of: &'static str },
}

/// Checks that a message of the library's log is not empty.
unsafe extern "C" fn logged(level: u32, message: *const c_char, _: *mut c_void) {
    // SAFETY: NUL-terminated (header).
    let message = unsafe { std::ffi::CStr::from_ptr(message) };
    assert!(!message.is_empty() && (1..=5).contains(&level));
}

/// The names of files: those that can be read, that can be written, and neither.
fn files() -> &'static [CString] {
    static ALL: OnceLock<(tempfile::TempDir, Vec<CString>)> = OnceLock::new();
    &ALL.get_or_init(|| {
        let folder = tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap();
        let seeds = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("seeds");
        let given = [
            ("obj/plain", "m.obj"),
            ("off/plain", "m.off"),
            ("ply/ascii", "m.ply"),
            ("stl/ascii", "m.stl"),
            ("glb/plain", "m.glb"),
            ("gifti/ascii", "m.gii"),
            ("gifti/labels", "m.label.gii"),
            ("spline/triangle.json", "s.json"),
            ("obj/plain", "text.glb"),
        ];
        for (seed, name) in given {
            std::fs::copy(seeds.join(seed), folder.path().join(name)).unwrap();
        }
        std::fs::create_dir(folder.path().join("folder.obj")).unwrap();
        let new = [
            "n.obj",
            "n.off",
            "n.ply",
            "n.glb",
            "n.gii",
            "n.json",
            "n.step",
            "folder.obj",
            "no/n.obj",
            "n.xyz",
            "n",
            "",
        ];
        let names = given.iter().map(|(_, name)| *name).chain(new);
        let in_folder = |name: &str| CString::new(folder.path().join(name).to_str().unwrap()).unwrap();
        let mut names: Vec<CString> = names.map(in_folder).collect();
        names.push(c"".into());
        names.push(c"\xff\xfe.obj".into());
        (folder, names)
    })
    .1
}

impl Session<'_> {
    /// Memory that lives until the session ends.
    pub fn keep(&mut self, bytes: Vec<u8>) -> usize {
        self.kept.push(bytes);
        self.kept.len() - 1
    }

    fn place(&self, kept: usize, at: usize) -> u64 {
        word(self.kept[kept].as_ptr()) + at as u64
    }

    /// A handle that is shared, or of this session alone; sometimes NULL.
    fn handle(&mut self, of: &'static str) -> u64 {
        let own = self.own.get(of).map_or(&[][..], Vec::as_slice);
        let all = self.shared.get(of).map_or(&[][..], Vec::as_slice);
        let b = self.tape.byte();
        // Without a control, mostly: a cancelled one ends everything at once.
        if b >= 244 || own.len() + all.len() == 0 || of == "ricci_control" && b >= 30 {
            return 0;
        }
        let k = usize::from(b) % (own.len() + all.len());
        *own.get(k).unwrap_or_else(|| &all[k - own.len()])
    }

    /// A handle of this session; it is taken from it where the call releases it.
    fn own(&mut self, of: &'static str, released: bool) -> u64 {
        let b = self.tape.below(8);
        let Some(own) = self.own.get_mut(of).filter(|own| !own.is_empty()) else { return 0 };
        let k = b % own.len();
        match (b, released) {
            (7, _) => 0,
            (_, true) => own.swap_remove(k),
            (_, false) => own[k],
        }
    }

    /// An array that is given; NULL sometimes, and not aligned sometimes.
    fn array(&mut self, of: &str, name: &str) -> u64 {
        let b = self.tape.byte();
        if b >= 240 {
            return 0;
        }
        let off = if b >= 200 { usize::from(b % 8) } else { 0 };
        let array = self.tape.array(of, name);
        let kept = self.keep([vec![0; off], array].concat());
        self.place(kept, off)
    }

    fn text(&mut self, name: &str) -> u64 {
        if self.tape.one_in(16) {
            return 0;
        }
        if name == "path" {
            let files = files();
            return word(files[self.tape.below(files.len())].as_ptr());
        }
        let mut text = match self.tape.below(4) {
            0 => b"a1 b1 a1^-1".to_vec(),
            1 => include_bytes!("../../seeds/spline/triangle.json").to_vec(),
            _ => self.tape.bytes(),
        };
        text.retain(|&b| b != 0);
        text.push(0);
        let kept = self.keep(text);
        self.place(kept, 0)
    }

    /// A number of a call or of a struct's field that decides how much work there is.
    fn size(&mut self, name: &str) -> usize {
        match name {
            "stride" => [0, 24, 32, 25, 8][self.tape.below(5)],
            // Most on the thread of the call: starting others takes longer than most calls.
            "threads" => [1, 2][usize::from(self.tape.one_in(32))],
            // By default, which is 0, the gradient flow makes thousands of steps.
            "max_iterations" => 1 + self.tape.below(40),
            "sides" | "parts" | "count" | "depth" | "least_loop" => self.tape.below(5),
            "genus" | "n_components" => self.tape.below(4),
            "m" => self.tape.below(9),
            // Of a curve, whose genus is half of it.
            "n_points" => self.tape.below(20),
            "limit" => 1 + self.tape.below(200),
            "n_curves" | "n_basis" | "n_straight" | "n_columns" => self.tape.below(9),
            "rings" => self.tape.below(4),
            "control_points" => 1 + self.tape.below(60),
            _ => self.tape.count(self.needed),
        }
    }

    /// A length or a tolerance that decides how much work there is.
    fn double(&mut self, name: &str) -> f64 {
        let x = self.tape.double();
        let least = match name {
            "edge" | "tolerance" | "angle" => 0.1,
            _ => 0.0,
        };
        // What is not positive, and what is no number, is refused, so it costs nothing.
        if x > 0.0 && x.is_finite() {
            x.clamp(least, if name == "radius" { 3.0 } else { f64::MAX })
        } else {
            x
        }
    }

    /// A tolerance that little work meets, or half of it, or one that is refused.
    fn coarse(&mut self, all: f64) -> f64 {
        let x = self.tape.double();
        if self.tape.one_in(64) {
            0.5 * all
        } else if x >= 0.0 {
            all
        } else {
            x
        }
    }

    /// The struct of one object, sometimes of none or two.
    fn objects(&mut self, of: &'static Struct) -> u64 {
        let (fields, full) = &layouts()[of.name];
        let mut bytes = vec![0; STRUCT_BYTES];
        bytes[..8].copy_from_slice(&full.to_ne_bytes());
        let n = [1, 1, 1, 1, 1, 1, 0, 2][self.tape.below(8)];
        for _ in 0..n {
            let (name, kind, start, _) = fields[self.tape.below(fields.len())];
            let value = match kind {
                Kind::Own(of) => self.handle(of),
                Kind::U32 if name == "mirrored" => self.tape.number().into(),
                _ => continue,
            };
            bytes[start..start + kind.size()].copy_from_slice(&value.to_ne_bytes()[..kind.size()]);
        }
        let kept = self.keep(bytes);
        self.place(kept, 0)
    }

    /// A struct that is given, with most fields zero.
    fn structure(&mut self, of: &'static Struct) -> u64 {
        if of.name == "ricci_objects" {
            return self.objects(of);
        }
        let is_long = LONG.contains(&of.name);
        let (fields, full) = &layouts()[of.name];
        // What is left out asks for a thread for each core.
        let has_threads = fields.iter().any(|(name, ..)| *name == "threads");
        if self.tape.one_in(if has_threads { 24 } else { 6 }) && !is_long {
            return 0;
        }
        let mut bytes = vec![0; STRUCT_BYTES];
        for &(name, kind, start, count) in fields {
            for k in 0..count {
                // A rectangle and a polygon, a shape and a target need most of their fields; others are left out more often.
                let used = self.tape.byte() % 4 < if fields.len() < 12 { 3 } else { 1 };
                if !used
                    && !is_long
                    && !matches!((of.name, name), ("ricci_shape", "n") | (_, "threads" | "max_iterations"))
                {
                    continue;
                }
                let value = match (of.name, name) {
                    (_, "rounds") if is_long => 1,
                    (_, "corrections") if is_long => u64::MAX,
                    (_, "control_points") if is_long => 1 + self.tape.below(12) as u64,
                    (_, "degree") if is_long => {
                        1 + u64::from(self.tape.one_in(8)) * self.tape.below(3) as u64
                    }
                    // Of knots that reach far, patches of a small surface reach themselves again and again.
                    (_, "spread") if is_long && !self.tape.one_in(32) => 0.2_f64.to_bits(),
                    ("ricci_bicubic_options", "tolerance") => self.coarse(1.0).to_bits(),
                    ("ricci_bicubic_options", "angle") => self.coarse(std::f64::consts::PI).to_bits(),
                    // A list of a few faces becomes as long as it is asked for.
                    ("ricci_refine_options", "levels") => {
                        if self.tape.one_in(16) {
                            u64::MAX
                        } else {
                            self.tape.below(4) as u64
                        }
                    }
                    ("ricci_refine_options", "longest_edge") => self.coarse(0.1).to_bits(),
                    (_, "size" | "reserved" | "reserved_too") => 0,
                    ("ricci_shape", "n") => self.tape.below(4) as u64,
                    ("ricci_match_options" | "ricci_uniform_options", "start") => 0,
                    (_, name) => self.value(kind, name),
                };
                let at = start + k * kind.size();
                bytes[at..at + kind.size()].copy_from_slice(&value.to_ne_bytes()[..kind.size()]);
            }
        }
        let size = match self.tape.byte() {
            255 => {
                // What a shorter struct does not have is as it is by default: too long for some.
                let shorter = if is_long { [0, 4, 7, 0] } else { [0, 8, 17, full - 8] };
                let larger = [full + 8, STRUCT_BYTES, STRUCT_BYTES + 8, usize::MAX];
                [shorter, larger].concat()[self.tape.below(8)]
            }
            254 => {
                // A field that this version does not know.
                bytes[*full] = 1;
                full + 8
            }
            _ => *full,
        };
        bytes[..8].copy_from_slice(&size.to_ne_bytes());
        let kept = self.keep(bytes);
        self.place(kept, 0)
    }

    /// A parameter that stands for itself, or a field.
    fn value(&mut self, kind: Kind, name: &str) -> u64 {
        match kind {
            Kind::F64 => self.double(name).to_bits(),
            Kind::U32 if name == "degree" && !self.tape.one_in(16) => self.tape.below(4) as u64,
            Kind::U32 if name == "rounds" || name == "p" || name == "q" => self.tape.below(4) as u64,
            Kind::U32 | Kind::I32 | Kind::U64 => self.tape.number().into(),
            Kind::Size => self.size(name) as u64,
            Kind::Handle(of) => self.handle(of),
            Kind::Given(of) => self.structure(of),
            // Their number of entries is not given, but follows from the mesh: more than other arrays have.
            Kind::In(..) if matches!(name, "normals" | "colors" | "uv" | "corner_normals") => {
                static HALVES: [f64; 8 * UNCOUNTED] = [0.5; 8 * UNCOUNTED];
                word(HALVES.as_ptr())
            }
            Kind::In(of, _) => self.array(of, name),
            Kind::Text => self.text(name),
            Kind::Callback if self.tape.one_in(4) => 0,
            Kind::Callback => logged as *const () as u64,
            other => panic!("{name}: {other:?} in a struct"),
        }
    }

    /// A buffer for results: with room, with too little, NULL.
    fn buffer(&mut self, of: &'static str, bytes: usize, with_capacity: bool) -> u64 {
        // Some capacities count rows: those of a buffer that has that of the one behind it, and of places in charts.
        let rows = 4;
        let (capacity, given) = match self.tape.byte() % 8 {
            0 => (0, false),
            1 => (usize::from(self.tape.byte()) % (MOST_ROWS + 1), true),
            2 => (self.needed.min(CAPACITY), true),
            3 => (8, false),
            _ => (CAPACITY, true),
        };
        self.pending = Some(capacity);
        if !given {
            return 0;
        }
        let at = if self.tape.one_in(8) { 1 } else { 0 };
        let room = if with_capacity { capacity } else { UNCOUNTED };
        let kept = self.keep(vec![UNTOUCHED; at + rows * (room + MOST_ROWS) * bytes]);
        let capacity = with_capacity.then_some(capacity);
        self.watched.push(Watched::Buffer { kept, at, word: of, bytes, capacity });
        self.place(kept, at)
    }

    /// The argument of a parameter; `next` is the name of the one behind it.
    pub fn argument(&mut self, kind: Kind, name: &str, next: &str, releases: bool) -> u64 {
        match kind {
            Kind::Size if name == "size" || name.ends_with("capacity") => {
                self.pending.take().unwrap_or_default() as u64
            }
            Kind::Out(of, bytes) => self.buffer(of, bytes, next.ends_with("capacity")),
            Kind::Words => self.buffer("char", 1, true),
            Kind::Own(of) => self.own(of, releases),
            Kind::Made(of) => {
                if self.tape.one_in(16) {
                    return 0;
                }
                let kept = self.keep(vec![UNTOUCHED; 8]);
                self.watched.push(Watched::Made { kept, of });
                self.place(kept, 0)
            }
            Kind::Filled(of) => {
                let full = layouts()[of.name].1;
                let odd = [0, 8, 17, full - 8, full + 8, STRUCT_BYTES, STRUCT_BYTES + 8, usize::MAX];
                let size = if self.tape.one_in(4) { odd[self.tape.below(8)] } else { full };
                self.pending = Some(size);
                if self.tape.one_in(16) {
                    return 0;
                }
                let kept = self.keep(vec![UNTOUCHED; STRUCT_BYTES + 8]);
                self.watched.push(Watched::Struct { kept, of, size });
                self.place(kept, 0)
            }
            Kind::Any => {
                self.pending = Some([16, 64, 8, 0, 17, STRUCT_BYTES, usize::MAX][self.tape.below(7)]);
                if self.tape.one_in(8) {
                    return 0;
                }
                let kept = self.keep(vec![UNTOUCHED; STRUCT_BYTES + 8]);
                self.place(kept, 0)
            }
            _ => self.value(kind, name),
        }
    }
}

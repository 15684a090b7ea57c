//! The report of a command: one JSON object with all numbers of the run.

use crate::failure::Failure;
use crate::input::Input;
use crate::listed::named;
pub use crate::timing::{PhaseSeconds, timed};
use ricci::mesh::Mesh;
use ricci::mesh::check::Diagnosis;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::path::Path;

/// The figures of a result by name, in the order in which the report has them.
#[derive(Default, Clone)]
pub struct Figures(Vec<(&'static str, Value)>);

impl Figures {
    /// These figures and one more; a value that is none, or a number that is not finite, is null.
    pub fn with(mut self, name: &'static str, value: impl Into<Value>) -> Figures {
        self.0.push((name, value.into()));
        self
    }

    /// These figures, then others.
    pub fn and(mut self, others: &Figures) -> Figures {
        self.0.extend(others.0.iter().cloned());
        self
    }

    /// These figures and one more, where it has a value.
    pub fn if_some(self, name: &'static str, value: Option<impl Into<Value>>) -> Figures {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }

    /// These figures and, where there are any, the options whose files could not be made, with the reasons.
    pub fn failed(self, failed: &Attempts) -> Figures {
        let failed: Map<String, Value> =
            failed.0.iter().map(|(option, why)| (option.to_string(), why.as_str().into())).collect();
        self.if_some("failed", (!failed.is_empty()).then_some(failed))
    }

    /// These figures and the counts of a surface.
    pub fn counts(self, of: Counts) -> Figures {
        self.with("vertices", of.vertices)
            .with("edges", of.edges)
            .with("faces", of.faces)
            .with("components", of.components)
            .with("euler", of.euler)
            .with("genus", of.genus)
            .with("boundary_loops", of.boundary_loops)
    }
}

impl Serialize for Figures {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// The report of one run, with the options of its command and their result.
#[derive(Serialize)]
pub struct RunReport<O, R> {
    ricci: &'static str,
    version: &'static str,
    command: &'static str,
    /// The surface of the command; none for `demo`, which makes its own surfaces, and for commands that read splines.
    input: Option<InputSummary>,
    options: O,
    result: R,
    checks: Checks,
    seconds: PhaseSeconds,
    peak_bytes: Option<u64>,
}

impl<O, R> RunReport<O, R> {
    pub fn new(command: &'static str, input: impl Into<Option<InputSummary>>, options: O, result: R) -> Self {
        let version = env!("CARGO_PKG_VERSION");
        let (checks, seconds) = (Checks::default(), PhaseSeconds::default());
        let input = input.into();
        RunReport {
            ricci: version,
            version,
            command,
            input,
            options,
            result,
            checks,
            seconds,
            peak_bytes: None,
        }
    }

    /// The report of a run that is over.
    pub fn finished(self, checks: Checks, seconds: PhaseSeconds) -> Self {
        RunReport { checks, seconds, peak_bytes: peak_bytes(), ..self }
    }
}

/// The size and topology of a surface. Figures that a defective list of triangles does not have are null.
#[derive(Serialize, Clone)]
pub struct Counts {
    pub vertices: usize,
    pub edges: usize,
    pub faces: usize,
    pub components: usize,
    pub euler: i64,
    pub genus: Option<usize>,
    pub boundary_loops: usize,
}

impl From<&Mesh> for Counts {
    fn from(mesh: &Mesh) -> Counts {
        Counts {
            vertices: mesh.n_vertices(),
            edges: mesh.n_edges(),
            faces: mesh.n_faces(),
            components: 1,
            euler: mesh.euler(),
            genus: Some(mesh.genus()),
            boundary_loops: mesh.boundary_loops().len(),
        }
    }
}

impl From<&Diagnosis> for Counts {
    fn from(found: &Diagnosis) -> Counts {
        let Diagnosis { vertices, edges, faces, components, euler, genus, boundary_loops, .. } = *found;
        Counts { vertices, edges, faces, components, euler, genus, boundary_loops }
    }
}

/// The surface that a command worked on.
#[derive(Serialize, Clone)]
pub struct InputSummary {
    pub path: String,
    #[serde(flatten)]
    pub counts: Counts,
    /// The second surface of a command that takes two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Box<InputSummary>>,
}

impl InputSummary {
    pub fn new(path: &Path, counts: impl Into<Counts>) -> InputSummary {
        InputSummary { path: path_text(path), counts: counts.into(), target: None }
    }

    pub fn of(input: &Input) -> InputSummary {
        InputSummary::new(&input.path, input.mesh())
    }

    /// Both surfaces of a command that takes two.
    pub fn with_target(self, target: InputSummary) -> InputSummary {
        InputSummary { target: Some(Box::new(target)), ..self }
    }
}

pub fn path_text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// A measured value against what it must not exceed.
#[derive(Serialize, Clone)]
pub struct Check {
    pub value: f64,
    pub limit: f64,
    pub holds: bool,
    /// Where it fails.
    #[serde(rename = "where", skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
    /// What lets it hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub remedy: Option<String>,
}

/// Checks by name.
#[derive(Serialize, Default, Clone)]
#[serde(transparent)]
pub struct Checks(pub BTreeMap<&'static str, Check>);

impl Checks {
    /// Add the check that `value` is at most `limit`; NaN is not.
    pub fn add(&mut self, name: &'static str, value: f64, limit: f64) {
        let check = Check { value, limit, holds: value <= limit, place: None, remedy: None };
        self.0.insert(name, check);
    }

    /// Add the check that `value` is at most `limit`, with what lets it hold.
    pub fn add_with_remedy(&mut self, name: &'static str, value: f64, limit: f64, remedy: &str) {
        self.add(name, value, limit);
        if let Some(check) = self.0.get_mut(name).filter(|check| !check.holds) {
            check.remedy = Some(remedy.into());
        }
    }

    /// Add the check that a list is empty. Where it is not, its elements are named, and a `remedy` if there is one.
    pub fn add_none<Id: ToString>(
        &mut self,
        name: &'static str,
        [one, many]: [&str; 2],
        list: &[Id],
        remedy: Option<&str>,
    ) {
        self.add(name, list.len() as f64, 0.0);
        if let Some(check) = self.0.get_mut(name).filter(|check| !check.holds) {
            (check.place, check.remedy) = (Some(named(one, many, list)), remedy.map(String::from));
        }
    }

    pub fn failed(&self) -> Vec<&'static str> {
        self.0.iter().filter(|(_, c)| !c.holds).map(|(name, _)| *name).collect()
    }

    /// The exit code of a run with these checks.
    pub fn exit_code(&self) -> u8 {
        u8::from(!self.failed().is_empty())
    }
}

/// A command that has run: what is told of it once its files are in place.
pub struct Done {
    pub checks: Checks,
    /// The options whose files could not be made, with the reasons.
    pub failed: Attempts,
    /// The numbers of vertices and faces that the file of `--uv` has beyond the input's.
    pub added: [usize; 2],
    /// The attributes of the input that the written file has no place for.
    pub left_out: Vec<String>,
    /// The files written.
    pub files: Vec<String>,
    pub seconds: f64,
    pub exit_code: u8,
    /// The lines for stdout; empty with `--quiet`.
    pub summary: String,
}

/// The options that could not be fulfilled, with the reasons.
#[derive(Default)]
pub struct Attempts(pub BTreeMap<&'static str, String>);

impl Attempts {
    /// Each reason once, with the options that failed for it.
    pub fn by_cause(&self) -> Vec<(Vec<&'static str>, &str)> {
        let mut causes: Vec<(Vec<&'static str>, &str)> = Vec::new();
        for (&option, why) in &self.0 {
            match causes.iter_mut().find(|(_, known)| known == why) {
                Some((options, _)) => options.push(option),
                None => causes.push((vec![option], why)),
            }
        }
        causes
    }

    /// Remember one reason under all the options of a list that were asked for.
    pub fn refuse(&mut self, why: &str, options: &[(&'static str, bool)]) {
        let asked = options.iter().filter(|(_, is_asked)| *is_asked);
        self.0.extend(asked.map(|(option, _)| (*option, why.to_string())));
    }

    /// The value of `result`. Where there is none, the reason is remembered under the `option`, so that everything else that was asked
    /// for is still delivered.
    ///
    /// # Errors
    /// [`Failure::Cancelled`] alone.
    pub fn attempt<T>(
        &mut self,
        option: &'static str,
        result: Result<T, Failure>,
    ) -> Result<Option<T>, Failure> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(Failure::Cancelled) => Err(Failure::Cancelled),
            Err(failure) => {
                self.0.insert(option, failure.to_string());
                Ok(None)
            }
        }
    }
}

/// The most memory that this process has held; known on Linux alone.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kib)
}

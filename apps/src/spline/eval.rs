//! `ricci spline eval` as a job: points, derivatives and triangles of a spline.

use super::args::EvalArgs;
use super::picture::draw;
use crate::csv::read_rows;
use crate::failure::Failure;
use crate::options::FileName;
use crate::output::{Outputs, check_extension, check_mesh_extension, check_outputs, format_of};
use crate::report::{Done, Figures, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::count;
use ricci::Control;
use ricci::mesh::io;
use ricci::spline::{ClosestPoint, Parameter, Spline, SurfacePoint};
use std::io::Write;
use std::path::Path;
use std::str::FromStr;

/// The contents of the file of `-o`.
enum EvalOutput<'a> {
    Rows { at: &'a Path, out: &'a Path },
    Nearest { to: &'a Path, out: &'a Path },
    Mesh { sides: u16, out: &'a Path },
    Nothing,
}

impl EvalOutput<'_> {
    fn of(args: &EvalArgs) -> Result<EvalOutput<'_>, Failure> {
        if let (Some(out), Some(to)) = (args.out.as_deref(), args.closest.as_deref()) {
            return Ok(EvalOutput::Nearest { to, out });
        }
        match (args.out.as_deref(), args.at.as_deref(), args.tessellate) {
            (Some(out), Some(at), _) => Ok(EvalOutput::Rows { at, out }),
            (Some(out), None, Some(sides)) => Ok(EvalOutput::Mesh { sides, out }),
            (None, None, _) => Ok(EvalOutput::Nothing),
            (Some(_), None, None) => Err(Failure::Usage(
                "-o: say with --at Q.csv, --closest P.csv or --tessellate N what is to be written".into(),
            )),
            (None, Some(_), _) => Err(Failure::Usage("--at: say with -o where the rows go".into())),
        }
    }
}

/// A spline, with the file of `-o` written already: its rows are written while they are computed.
pub struct EvalOutcome {
    out: Option<FileName>,
    spline: Spline,
    points: usize,
}

impl Job for EvalArgs {
    type Outcome = EvalOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "spline", common: &self.common, mesh: None }
    }

    fn check(&self) -> Result<(), Failure> {
        EvalOutput::of(self)?;
        let has_rows = self.at.is_some() || self.closest.is_some();
        match has_rows {
            true => check_extension("-o", self.out.as_deref(), &["csv"])?,
            false => check_mesh_extension("-o", self.out.as_deref(), &[])?,
        }
        check_extension("--picture", self.picture.picture.as_deref(), &["png"])?;
        let files = [&self.out, &self.picture.picture, &self.common.report];
        check_outputs(
            &[Some(&self.spline), self.at.as_deref(), self.closest.as_deref()],
            &files.map(|file| file.as_deref()),
        )
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<EvalOutcome, Failure> {
        let spline = timed(&mut run.seconds.read, || Spline::read(&self.spline))?;
        let write = || write_output(self, &spline, &mut run.outputs, run.control);
        let points = timed(&mut run.seconds.solve, write)?;
        Ok(EvalOutcome { out: self.out.clone(), spline, points })
    }

    fn write(&self, outcome: &EvalOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let control = run.control;
        run.draw(self.picture.picture.as_deref(), || draw(&outcome.spline, self, control))
    }
}

impl JobOutcome for EvalOutcome {
    type Figures = Figures;

    fn figures(&self, _: &CommandRun<'_>) -> Figures {
        let space = self.spline.space();
        Figures::default()
            .with("degree", space.degree())
            .with("patches", space.patches().len())
            .with("control_points", space.n_control_points())
            .with("points", self.points)
    }

    fn summary(&self, _: &Done) -> String {
        let points = count(self.points, "point", "points");
        self.out.as_ref().map_or_else(String::new, |out| format!("{}: {points}\n", out.display()))
    }
}

/// Write the file of `-o`; returns the number of its points.
fn write_output(
    args: &EvalArgs,
    spline: &Spline,
    outputs: &mut Outputs,
    control: &Control,
) -> Result<usize, Failure> {
    let threads = args.common.threads;
    match EvalOutput::of(args)? {
        EvalOutput::Rows { at, out } => {
            let places = places(at)?;
            let order = if args.derivatives { 2 } else { 0 };
            let found = if args.filled {
                spline.evaluate(&places, order, threads, control)?
            } else {
                spline.clone().with_holes(Vec::new()).evaluate(&places, order, threads, control)?
            };
            let in_hole = |&at: &Parameter| spline.is_in_hole(at);
            let holes = (!spline.holes().is_empty()).then(|| places.iter().map(in_hole).collect::<Vec<_>>());
            let rows = PointRows { places: &places, points: &found, derivatives: args.derivatives, holes };
            outputs.add(out, |file| rows.write(file))?;
            Ok(found.len())
        }
        EvalOutput::Nearest { to, out } => {
            let points = points(to)?;
            let found = spline.closest_points(threads, &control.part(0.0, 0.3))?.find(
                &points,
                threads,
                &control.part(0.3, 1.0),
            )?;
            outputs.add(out, |file| write_nearest(file, &points, &found))?;
            Ok(found.len())
        }
        EvalOutput::Mesh { sides, out } => {
            let soup = spline.tessellate(sides.into(), threads, control)?;
            let format = format_of(out)?;
            outputs.add_named(out, |path| io::write_as(path, format, &soup))?;
            Ok(soup.positions.len())
        }
        EvalOutput::Nothing => Ok(0),
    }
}

/// The rows of a file of places.
fn places(path: &Path) -> Result<Vec<Parameter>, Failure> {
    let place = |(line, [patch, x, y]): (usize, [String; 3])| {
        Ok(Parameter {
            patch: number(path, line, &patch)?,
            x: number(path, line, &x)?,
            y: number(path, line, &y)?,
        })
    };
    read_rows(path, ["patch", "x", "y"])?.into_iter().map(place).collect()
}

/// The rows of a file of points.
fn points(path: &Path) -> Result<Vec<[f64; 3]>, Failure> {
    let point = |(line, [x, y, z]): (usize, [String; 3])| {
        Ok([number(path, line, &x)?, number(path, line, &y)?, number(path, line, &z)?])
    };
    read_rows(path, ["x", "y", "z"])?.into_iter().map(point).collect()
}

fn number<T: FromStr>(path: &Path, line: usize, text: &str) -> Result<T, Failure> {
    let refuse = |_| Failure::Input(format!("{}:{line}: `{text}` is no number of a place", path.display()));
    text.parse().map_err(refuse)
}

fn write_nearest(out: &mut impl Write, points: &[[f64; 3]], nearest: &[ClosestPoint]) -> std::io::Result<()> {
    writeln!(out, "x,y,z,patch,u,v,X,Y,Z,distance")?;
    for ([x, y, z], found) in points.iter().zip(nearest) {
        let ClosestPoint { place, point, distance, .. } = found;
        let [a, b, c] = point;
        writeln!(out, "{x},{y},{z},{},{},{},{a},{b},{c},{distance}", place.patch, place.x, place.y)?;
    }
    Ok(())
}

/// The rows of `--at`.
struct PointRows<'a> {
    places: &'a [Parameter],
    points: &'a [SurfacePoint],
    derivatives: bool,
    /// Per place true if it lies in a hole; none for a spline without holes.
    holes: Option<Vec<bool>>,
}

impl PointRows<'_> {
    fn write(&self, out: &mut impl Write) -> std::io::Result<()> {
        write!(out, "patch,x,y,X,Y,Z")?;
        if self.derivatives {
            for name in ["x", "y", "xx", "xy", "yy"] {
                write!(out, ",X_{name},Y_{name},Z_{name}")?;
            }
            write!(out, ",NX,NY,NZ,k1,k2")?;
        }
        writeln!(out, "{}", if self.holes.is_some() { ",hole" } else { "" })?;
        for (i, (at, found)) in self.places.iter().zip(self.points).enumerate() {
            write!(out, "{},{},{}", at.patch, at.x, at.y)?;
            let derivatives = found.first.iter().chain(&found.second).flatten();
            let all = found.point.iter().chain(derivatives.filter(|_| self.derivatives));
            all.into_iter().try_for_each(|x| write!(out, ",{x}"))?;
            if self.derivatives {
                // There is no normal where the first derivatives are parallel: its fields stay empty.
                let normal =
                    found.normal().map_or_else(|| ",,".into(), |n| format!("{},{},{}", n[0], n[1], n[2]));
                let curvatures =
                    found.principal_curvatures().map_or_else(|| ",".into(), |[a, b]| format!("{a},{b}"));
                write!(out, ",{normal},{curvatures}")?;
            }
            let hole = self.holes.as_ref().map_or("", |holes| if holes[i] { ",1" } else { ",0" });
            writeln!(out, "{hole}")?;
        }
        Ok(())
    }
}

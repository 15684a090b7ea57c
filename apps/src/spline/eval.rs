//! `ricci spline eval`.

use super::args::EvalArgs;
use super::picture::draw;
use crate::csv::read_rows;
use crate::failure::Failure;
use crate::output::{Outputs, check_extension, check_outputs, format_of};
use crate::progress::Progress;
use crate::report::{Checks, Figures, Report, Seconds, timed};
use crate::say::{self, count};
use ricci::Control;
use ricci::mesh::io;
use ricci::spline::{ClosestPoint, Parameter, Spline, SurfacePoint};
use std::io::Write;
use std::path::Path;
use std::str::FromStr;
use std::time::Instant;

/// What `-o` is to hold.
enum Wanted<'a> {
    Rows { at: &'a Path, out: &'a Path },
    Nearest { to: &'a Path, out: &'a Path },
    Mesh { sides: u16, out: &'a Path },
    Nothing,
}

impl Wanted<'_> {
    fn of(args: &EvalArgs) -> Result<Wanted<'_>, Failure> {
        if let (Some(out), Some(to)) = (args.out.as_deref(), args.closest.as_deref()) {
            return Ok(Wanted::Nearest { to, out });
        }
        match (args.out.as_deref(), args.at.as_deref(), args.tessellate) {
            (Some(out), Some(at), _) => Ok(Wanted::Rows { at, out }),
            (Some(out), None, Some(sides)) => Ok(Wanted::Mesh { sides, out }),
            (None, None, _) => Ok(Wanted::Nothing),
            (Some(_), None, None) => Err(Failure::Usage(
                "-o: say with --at Q.csv, --closest P.csv or --tessellate N what is to be written".into(),
            )),
            (None, Some(_), _) => Err(Failure::Usage("--at: say with -o where the rows go".into())),
        }
    }
}

/// Evaluate a spline at places, or all over, and draw it.
pub fn eval(args: &EvalArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let wanted = Wanted::of(args)?;
    let known: &[&str] =
        if args.at.is_some() || args.closest.is_some() { &["csv"] } else { &["obj", "off", "ply", "glb"] };
    let picture = args.picture.picture.as_deref();
    check_extension("-o", args.out.as_deref(), known)?;
    check_extension("--picture", picture, &["png"])?;
    check_outputs(
        &[Some(&args.spline), args.at.as_deref(), args.closest.as_deref()],
        &[args.out.as_deref(), picture, args.common.report.as_deref()],
    )?;
    let progress = Progress::watch(control, args.common.quiet);
    let mut seconds = Seconds::default();
    let spline = timed(&mut seconds.read, || Spline::read(&args.spline))?;
    let mut outputs = Outputs::default();
    let points = timed(&mut seconds.solve, || write(&wanted, &spline, args, (&mut outputs, control)))?;
    if let Some(path) = picture {
        let drawn = timed(&mut seconds.picture, || draw(&spline, args, control));
        outputs.add_bytes(path, &drawn?)?;
    }
    if let Some(path) = &args.common.report {
        let space = spline.space();
        let figures = Figures::default()
            .with("degree", space.degree())
            .with("patches", space.patches().len())
            .with("control_points", space.n_control_points())
            .with("points", points);
        seconds.total = start.elapsed().as_secs_f64();
        let report = Report::new("spline", None, args, figures);
        outputs.add_report(path, &report.finished(Checks::default(), seconds))?;
    }
    control.check()?;
    let files = outputs.commit()?;
    drop(progress);
    if !args.common.quiet {
        let text = args.out.as_ref().map_or_else(String::new, |out| {
            format!("{}: {}\n", out.display(), count(points, "point", "points"))
        });
        say::lines(&text, &files)?;
    }
    Ok(0)
}

/// Add what `-o` is to hold; returns how many points that is.
fn write(
    wanted: &Wanted<'_>,
    spline: &Spline,
    args: &EvalArgs,
    (outputs, control): (&mut Outputs, &Control),
) -> Result<usize, Failure> {
    let threads = args.common.threads;
    match *wanted {
        Wanted::Rows { at, out } => {
            let places = places(at)?;
            let order = if args.derivatives { 2 } else { 0 };
            let found = match args.filled {
                true => spline.evaluate(&places, order, threads, control)?,
                false => spline.clone().with_holes(Vec::new()).evaluate(&places, order, threads, control)?,
            };
            let in_hole = |&at: &Parameter| spline.is_in_hole(at);
            let holes = (!spline.holes().is_empty()).then(|| places.iter().map(in_hole).collect::<Vec<_>>());
            let rows = Rows { places: &places, points: &found, derivatives: args.derivatives, holes };
            outputs.add(out, |file| rows.write(file))?;
            Ok(found.len())
        }
        Wanted::Nearest { to, out } => {
            let points = points(to)?;
            let found = spline.closest_points(threads, control)?.find(&points, threads, control)?;
            outputs.add(out, |file| write_nearest(file, &points, &found))?;
            Ok(found.len())
        }
        Wanted::Mesh { sides, out } => {
            let soup = spline.tessellate(sides.into(), threads, control)?;
            let format = format_of(out)?;
            outputs.add_named(out, |path| io::write_as(path, format, &soup))?;
            Ok(soup.positions.len())
        }
        Wanted::Nothing => Ok(0),
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
struct Rows<'a> {
    places: &'a [Parameter],
    points: &'a [SurfacePoint],
    derivatives: bool,
    /// Of a spline with holes, whether a place is in one.
    holes: Option<Vec<bool>>,
}

impl Rows<'_> {
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
                // Where the first derivatives are parallel there is no normal: the fields stay empty.
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

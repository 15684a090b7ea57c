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
use ricci::spline::{Parameter, Spline, SurfacePoint};
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// What `-o` is to hold.
enum Wanted<'a> {
    Rows { at: &'a Path, out: &'a Path },
    Mesh { sides: u16, out: &'a Path },
    Nothing,
}

impl Wanted<'_> {
    fn of(args: &EvalArgs) -> Result<Wanted<'_>, Failure> {
        match (args.out.as_deref(), args.at.as_deref(), args.tessellate) {
            (Some(out), Some(at), _) => Ok(Wanted::Rows { at, out }),
            (Some(out), None, Some(sides)) => Ok(Wanted::Mesh { sides, out }),
            (None, None, _) => Ok(Wanted::Nothing),
            (Some(_), None, None) => {
                Err(Failure::Usage("-o: say with --at Q.csv or --tessellate N what is to be written".into()))
            }
            (None, Some(_), _) => Err(Failure::Usage("--at: say with -o where the rows go".into())),
        }
    }
}

/// Evaluate a spline at places, or all over, and draw it.
pub fn eval(args: &EvalArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let wanted = Wanted::of(args)?;
    let known: &[&str] = if args.at.is_some() { &["csv"] } else { &["obj", "off", "ply", "glb"] };
    let picture = args.picture.base.picture.as_deref();
    check_extension("-o", args.out.as_deref(), known)?;
    check_extension("--picture", picture, &["png"])?;
    check_outputs(
        &[Some(&args.spline), args.at.as_deref()],
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
            let found = spline.evaluate(&places, if args.derivatives { 2 } else { 0 }, threads, control)?;
            outputs.add(out, |file| write_rows(file, &places, &found, args.derivatives))?;
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
    let refuse = |line: usize, what: &str| {
        Failure::Input(format!("{}:{line}: `{what}` is no number of a place", path.display()))
    };
    let place = |(line, [patch, x, y]): (usize, [String; 3])| {
        let number = |text: &String| text.parse::<f64>().map_err(|_| refuse(line, text));
        Ok(Parameter {
            patch: patch.parse().map_err(|_| refuse(line, &patch))?,
            x: number(&x)?,
            y: number(&y)?,
        })
    };
    read_rows(path, ["patch", "x", "y"])?.into_iter().map(place).collect()
}

fn write_rows(
    out: &mut impl Write,
    places: &[Parameter],
    points: &[SurfacePoint],
    derivatives: bool,
) -> std::io::Result<()> {
    write!(out, "patch,x,y,X,Y,Z")?;
    if derivatives {
        for name in ["x", "y", "xx", "xy", "yy"] {
            write!(out, ",X_{name},Y_{name},Z_{name}")?;
        }
        write!(out, ",NX,NY,NZ,k1,k2")?;
    }
    writeln!(out)?;
    for (at, found) in places.iter().zip(points) {
        write!(out, "{},{},{}", at.patch, at.x, at.y)?;
        let mut numbers = found.point.to_vec();
        if derivatives {
            numbers.extend(found.first.iter().chain(&found.second).flatten());
        }
        for x in numbers {
            write!(out, ",{x}")?;
        }
        if derivatives {
            // Where the first derivatives are parallel there is no normal: the fields stay empty.
            let normal =
                found.normal().map_or_else(|| ",,".into(), |n| format!("{},{},{}", n[0], n[1], n[2]));
            let curvatures =
                found.principal_curvatures().map_or_else(|| ",".into(), |[a, b]| format!("{a},{b}"));
            write!(out, ",{normal},{curvatures}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

//! `ricci spline eval`.

use super::args::EvalArgs;
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
use std::time::Instant;

/// Evaluate a spline at places, or all over.
pub fn eval(args: &EvalArgs, control: &Control) -> Result<u8, Failure> {
    let start = Instant::now();
    let known: &[&str] = if args.at.is_some() { &["csv"] } else { &["obj", "off", "ply", "glb"] };
    check_extension("-o", Some(&args.out), known)?;
    check_outputs(
        &[Some(&args.spline), args.at.as_deref()],
        &[Some(&*args.out), args.common.report.as_deref()],
    )?;
    let progress = Progress::watch(control, args.common.quiet);
    let mut seconds = Seconds::default();
    let spline = timed(&mut seconds.read, || Spline::read(&args.spline))?;
    let mut outputs = Outputs::default();
    let points = match &args.at {
        Some(path) => {
            let places = places(path)?;
            let order = if args.derivatives { 2 } else { 0 };
            let found =
                timed(&mut seconds.solve, || spline.evaluate(&places, order, args.common.threads, control))?;
            outputs.add(&args.out, |out| write_rows(out, &places, &found, args.derivatives))?;
            found.len()
        }
        None => {
            let n = args.tessellate.unwrap_or(1).into();
            let soup = timed(&mut seconds.solve, || spline.tessellate(n, args.common.threads, control))?;
            let format = format_of(&args.out)?;
            outputs.add_named(&args.out, |path| io::write_as(path, format, &soup))?;
            soup.positions.len()
        }
    };
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
        let text = format!("{}: {}\n", args.out.display(), count(points, "point", "points"));
        say::lines(&text, &files)?;
    }
    Ok(0)
}

/// The rows of a file of places.
fn places(path: &std::path::Path) -> Result<Vec<Parameter>, Failure> {
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

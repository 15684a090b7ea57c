//! The job of `ricci view`: files are read and packed into one page.

use super::args::ViewArgs;
use super::quantities::{of_file, of_table, of_texture};
use crate::failure::Failure;
use crate::input::{self, FileContent};
use crate::options::MeshArgs;
use crate::output::{STANDARD, check_extension, check_outputs};
use crate::page::{PageView, ViewSides, of_views};
use crate::picture;
use crate::report::{Done, path_text, timed};
use crate::runner::{CommandRun, Job, JobHeader, JobOutcome};
use crate::say::count;
use ricci::control::Stage;
use ricci::mesh::io::Soup;
use serde::Serialize;
use std::path::Path;

/// The views of a page, each under the name of its file.
pub struct ViewOutcome {
    views: Vec<(String, PageView)>,
    figures: Vec<ViewFigures>,
}

/// A view as the report has it.
#[derive(Serialize, Clone)]
pub struct ViewFigures {
    path: String,
    /// The vertices, those on a seam counted on each of its sides.
    vertices: usize,
    faces: usize,
    /// The second side: `texture`, `image` or none.
    beside: Option<&'static str>,
    quantities: Vec<String>,
    /// The faces that are not shown, for a vertex that is not there or a number that is not finite.
    faces_left_out: usize,
}

/// The result of the command, as its report has it.
#[derive(Serialize)]
pub struct PageFigures {
    views: Vec<ViewFigures>,
}

impl Job for ViewArgs {
    type Outcome = ViewOutcome;

    fn header(&self) -> JobHeader<'_> {
        JobHeader { name: "view", common: &self.common, mesh: self.files.first().map(|path| &**path) }
    }

    fn check(&self) -> Result<(), Failure> {
        check_extension("-o", Some(&self.out), &["html", "htm"])?;
        if self.image.is_some() && self.files.len() > 1 {
            return Err(Failure::Usage(
                "--image is shown beside one surface; name a single file, or make a page for each".into(),
            ));
        }
        let inputs = self.files.iter().map(|path| &**path).chain(self.image.as_deref());
        let inputs: Vec<Option<&Path>> =
            inputs.chain(self.values.iter().map(|path| &**path)).map(Some).collect();
        if inputs.iter().filter(|path| **path == Some(Path::new(STANDARD))).count() > 1 {
            return Err(Failure::Usage("- names stdin, which can be read once".into()));
        }
        check_outputs(&inputs, &[Some(&*self.out), self.common.report.as_deref()])
    }

    fn compute(&self, run: &mut CommandRun<'_>) -> Result<ViewOutcome, Failure> {
        let (mut views, mut figures) = (Vec::new(), Vec::new());
        for (k, path) in self.files.iter().enumerate() {
            run.control.step(Stage::Read, k as f64 / self.files.len() as f64)?;
            let soup = timed(&mut run.seconds.read, || triangles(path))?;
            let (view, told) = timed(&mut run.seconds.build, || self.view(path, &soup))?;
            views.push((path_text(path), view));
            figures.push(told);
        }
        Ok(ViewOutcome { views, figures })
    }

    fn write(&self, outcome: &ViewOutcome, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let names: Vec<&str> = outcome.views.iter().map(|(name, _)| &name[..]).collect();
        let title = self.title.clone().unwrap_or_else(|| names.join(", "));
        let page = of_views(&title, &outcome.views)?;
        run.outputs.add_bytes(&self.out, page.as_bytes())
    }
}

impl ViewArgs {
    /// The view of a file, and its figures.
    fn view(&self, path: &Path, soup: &Soup) -> Result<(PageView, ViewFigures), Failure> {
        let n = soup.positions.len();
        let tables = self.values.iter().map(|table| of_table(table, n));
        let mut quantities = tables.collect::<Result<Vec<_>, _>>()?;
        quantities.extend(of_file(soup));
        let sides = match &self.image {
            Some(image) => ViewSides::imaged(soup, &image_of(image, path, n)?),
            None => ViewSides::textured(soup),
        };
        if sides.corners.is_empty() {
            return Err(Failure::Input(format!(
                "{}: no face could be shown; `ricci info` says what is wrong with them",
                path.display()
            )));
        }
        let beside = match (&sides.image, sides.flat) {
            (Some(_), true) => {
                quantities.extend(of_texture(&sides, n)?);
                Some("texture")
            }
            (Some(_), false) => Some("image"),
            (None, _) => None,
        };
        let up = self.up.as_deref().map(picture::direction);
        let view = PageView::new(&sides, up, &quantities);
        let figures = ViewFigures {
            path: path_text(path),
            vertices: view.vertices(),
            faces: view.faces(),
            beside,
            quantities: quantities.into_iter().map(|quantity| quantity.name).collect(),
            faces_left_out: sides.left_out,
        };
        Ok((view, figures))
    }
}

/// The triangles of a file. One that holds none says which command makes some of it.
fn triangles(path: &Path) -> Result<Soup, Failure> {
    let refuse = |why: &str| Failure::Input(format!("{}: {why}", path.display()));
    match input::content(&MeshArgs { mesh: path.into(), weld: None })? {
        FileContent::Triangles(soup) => match input::out_of_range(&soup) {
            Some(why) => Err(refuse(&why)),
            None => Ok(*soup),
        },
        FileContent::Lengths(text) if text.contains("\"ricci-spline") => Err(refuse(
            "a spline has no triangles; `ricci spline eval FILE --tessellate 4 -o MESH.obj` makes some",
        )),
        FileContent::Lengths(_) => Err(refuse(
            "a metric has no triangles in space; `ricci flow FILE --flat FLAT.obj` makes some of its layout",
        )),
    }
}

/// The places of the vertices of `--image`, as many as the surface has.
fn image_of(image: &Path, surface: &Path, n: usize) -> Result<Vec<ricci::mesh::Point>, Failure> {
    let found = triangles(image)?.positions;
    if found.len() == n {
        return Ok(found);
    }
    Err(Failure::Input(format!(
        "{}: {}, and {} has {n}: the image needs the vertices of the surface, in their order",
        image.display(),
        count(found.len(), "vertex", "vertices"),
        surface.display()
    )))
}

impl JobOutcome for ViewOutcome {
    type Figures = PageFigures;

    fn figures(&self, _: &CommandRun<'_>) -> PageFigures {
        PageFigures { views: self.figures.clone() }
    }

    fn summary(&self, done: &Done) -> String {
        let mut text = String::new();
        for told in &self.figures {
            let beside = told.beside.map_or("alone", |what| match what {
                "texture" => "beside its texture coordinates",
                _ => "beside its image",
            });
            let [vertices, faces] =
                [count(told.vertices, "vertex", "vertices"), count(told.faces, "face", "faces")];
            text += &format!("surface  {}: {vertices}, {faces}, {beside}\n", told.path);
            if !told.quantities.is_empty() {
                text += &format!("colours  {}\n", told.quantities.join(", "));
            }
            if told.faces_left_out > 0 {
                let faces = count(told.faces_left_out, "face", "faces");
                let why = "a vertex is not there or a number not finite (ricci info)";
                text += &format!("left out {faces} of {}: {why}\n", told.path);
            }
        }
        text + &format!("wrote    {}\n{:.2} s\n", done.files.join(", "), done.seconds)
    }
}

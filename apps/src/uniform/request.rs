//! What is asked of the commands, and what they refuse.

use super::args::{CanonicalArgs, ModelChoice, ShowChoice, Shown, TilesChoice};
use super::model_place::ModelPlace;
use super::needs::Needs;
use super::quotient::Uniformized;
use crate::failure::Failure;
use crate::input::Input;
use crate::options::{FlipsChoice, MethodChoice, OnChoice, SchemeChoice};
use crate::output::{check_extension, check_outputs};
use crate::picture::{PictureArgs, Texture};
use crate::report::path_text;
use crate::show::is_svg;
use ricci::Control;
use ricci::embed::cover::{elements_to_depth, elements_within};
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Copies to make, and where they are written.
#[derive(Clone, Copy)]
pub struct CoverWish<'a> {
    pub depth: usize,
    pub radius: Option<f64>,
    pub limit: usize,
    pub cover: Option<&'a Path>,
    pub domain: Option<&'a Path>,
}

/// What is common to both commands.
pub struct Wish<'a> {
    pub args: &'a CanonicalArgs,
    pub command: &'static str,
    pub shown: Option<Shown>,
    pub model: Option<ModelChoice>,
    pub cover: Option<CoverWish<'a>>,
}

impl CoverWish<'_> {
    /// What says how many copies are asked for.
    fn option(&self) -> &'static str {
        if self.radius.is_some() { "radius" } else { "depth" }
    }

    /// Find the copies that are asked for. Where there are too many, or no domain to find them by, files that show none are written all
    /// the same. Errors: [`Failure::Cancelled`] alone.
    pub fn find(&self, u: &mut Uniformized, control: &Control) -> Result<(), Failure> {
        let found = match self.radius.map(|radius| (radius, u.domain())) {
            None => elements_to_depth(&u.deck, self.depth, self.limit, control),
            Some((radius, Ok(domain))) => elements_within(&u.deck, domain, radius, self.limit, control),
            Some((_, Err(why))) => Err(ricci::Error::Layout(format!("{why}; use --depth"))),
        };
        let option = self.option();
        u.elements = match found {
            Ok(elements) => Ok(elements),
            Err(ricci::Error::Cancelled) => return Err(Failure::Cancelled),
            Err(ricci::Error::TooLarge { .. }) => {
                Err(format!("more than {} copies; lower --{option} or raise --limit", self.limit))
            }
            Err(error) => Err(error.to_string()),
        };
        if let Err(why) = &u.elements {
            u.failed.0.insert(option, why.clone());
        }
        Ok(())
    }
}

impl Wish<'_> {
    /// What the outputs that are asked for are made from.
    pub fn needs(&self, shown: Shown) -> Needs {
        let (report, drawn) = (self.args.common.report.is_some(), self.args.picture.picture.is_some());
        let of_domain = matches!(
            shown,
            Shown::Uniform(ShowChoice::Polygon | ShowChoice::Dirichlet) | Shown::Cover(TilesChoice::Tiles)
        );
        let by_domain = self.cover.is_some_and(|c| c.radius.is_some() || c.domain.is_some());
        let copies = self.cover.is_some_and(|c| c.cover.is_some());
        Needs {
            refinement: report || drawn || copies || self.args.uv.is_some(),
            on_input: self.args.on == OnChoice::Input && self.args.uv.is_some(),
            domain: report || by_domain || (drawn && of_domain),
        }
    }

    /// What can be refused before anything is read.
    pub fn check_request(&self) -> Result<(), Failure> {
        let args = self.args;
        let cover = self.cover.as_ref();
        let [copies, domain] = [cover.and_then(|c| c.cover), cover.and_then(|c| c.domain)];
        let meshes =
            [("--uv", args.uv.as_deref()), ("--sphere", args.sphere.as_deref()), ("--cover", copies)];
        for (option, path) in meshes {
            check_extension(option, path, &["obj", "glb"])?;
        }
        let picture = args.picture.picture.as_deref();
        check_extension("--picture", picture, &["png", "svg"])?;
        let in_space = matches!(self.shown, Some(Shown::Uniform(ShowChoice::Both | ShowChoice::Surface)));
        if in_space && picture.is_some_and(is_svg) {
            return Err(Failure::Usage(
                "--picture: an SVG shows no surface in space; use .png, or --show domain".into(),
            ));
        }
        let files = [
            args.metric.as_deref(),
            args.uv.as_deref(),
            args.sphere.as_deref(),
            args.generators.as_deref(),
            picture,
            args.common.report.as_deref(),
            copies,
            domain,
        ];
        check_outputs(&[Some(&args.surface.mesh)], &files)
    }

    /// What can be refused once the surface is known; what the picture shows.
    pub fn check_surface(&self, input: &Input) -> Result<Shown, Failure> {
        let mesh = input.mesh();
        let refuse = |why: &str| Err(Failure::Input(format!("{}: {why}", input.path.display())));
        if !mesh.is_closed() {
            return refuse(
                "the surface has a boundary, and closed surfaces only are uniformized so far; ricci flow lays out \
                 surfaces with boundary",
            );
        }
        if mesh.euler() > 0 {
            return self.check_sphere(input);
        }
        if self.args.sphere.is_some() {
            return Err(Failure::Usage(format!(
                "--sphere: a surface of genus {} is no sphere; use --uv",
                mesh.genus()
            )));
        }
        if self.model.is_some() && mesh.euler() == 0 {
            return Err(Failure::Usage(
                "--model: a torus lies in the plane, which has no other model".into(),
            ));
        }
        let usual = match (input.positions(), &self.args.picture.picture) {
            (Some(_), Some(path)) if !is_svg(path) => ShowChoice::Both,
            _ => ShowChoice::Domain,
        };
        let shown = self.shown.unwrap_or(Shown::Uniform(usual));
        if input.positions().is_none() {
            let nothing = "an intrinsic metric has no positions in space";
            if self.args.uv.is_some() {
                return Err(Failure::Usage(format!(
                    "--uv: {nothing}; `ricci cover --depth 0 --cover OUT.obj` writes the layout"
                )));
            }
            if let Shown::Uniform(ShowChoice::Both | ShowChoice::Surface) = shown {
                return Err(Failure::Usage(format!("--show: {nothing}; use domain")));
            }
        }
        Ok(shown)
    }

    /// The same for a sphere.
    fn check_sphere(&self, input: &Input) -> Result<Shown, Failure> {
        let (args, usage) = (self.args, |message: &str| Err(Failure::Usage(message.into())));
        if args.uv.is_some() {
            return usage("--uv: a sphere lies in no plane; use --sphere S.obj (or ricci flow, with cones)");
        }
        if self.model.is_some() {
            return usage("--model: a sphere is not in the hyperbolic plane");
        }
        if self.cover.is_some_and(|c| c.domain.is_some()) {
            return usage(
                "--domain: a sphere is its own universal cover; there is no fundamental domain to write",
            );
        }
        if args.solve.method == MethodChoice::Newton {
            if input.mesh().n_vertices() < 4 {
                let path = input.path.display();
                let why =
                    "a sphere of fewer than four vertices is no polyhedron; cut each triangle into four";
                return Err(Failure::Input(format!("{path}: {why}")));
            }
            if !matches!(args.solve.scheme, SchemeChoice::Yamabe) {
                return usage(
                    "--scheme: spheres flow by vertex scaling, yamabe; other schemes with --method gradient",
                );
            }
            if matches!(args.solve.flips, FlipsChoice::Never) {
                return usage("--flips never: spheres flip edges; without flips use --method gradient");
            }
        }
        if args.picture.picture.as_deref().is_some_and(is_svg) {
            return usage("--picture: an SVG shows no surface in space; use .png");
        }
        match self.shown {
            None | Some(Shown::Cover(_)) => Ok(Shown::Uniform(ShowChoice::Both)),
            Some(shown @ Shown::Uniform(ShowChoice::Both)) => Ok(shown),
            Some(shown @ Shown::Uniform(ShowChoice::Surface)) if input.positions().is_some() => Ok(shown),
            Some(_) => usage("--show: a sphere has no fundamental domain; use both"),
        }
    }

    /// Where copies lie.
    pub fn place(&self, space: Space) -> ModelPlace {
        ModelPlace::new(space, self.model.map_or(Model::Poincare, Model::from))
    }

    /// Where pictures lie: the hyperboloid is drawn as the Poincaré disk, which is its projection.
    pub fn drawn_place(&self, space: Space) -> ModelPlace {
        let drawn = self.model.filter(|model| *model != ModelChoice::Hyperboloid);
        ModelPlace::new(space, drawn.map_or(Model::Poincare, Model::from))
    }

    /// What was asked, defaults put in: a run with these options is this run.
    pub fn asked(&self, input: &Input, base: Option<u32>, shown: Shown) -> Asked {
        let args = self.args;
        let text = |path: &Option<PathBuf>| path.as_deref().map(path_text);
        let options = args.solve.options(args.common.threads());
        let space = if input.mesh().euler() < 0 { Space::H2 } else { Space::E2 };
        let drawn = args.picture.picture.is_some();
        Asked {
            weld: args.surface.weld,
            input_geometry: input.surface.geometry().name(),
            scheme: args.solve.scheme,
            method: args.solve.method,
            flips: args.solve.flips,
            tolerance: args.solve.tolerance,
            max_iterations: options.iteration_limit(),
            threads: args.common.threads(),
            base,
            model: (space == Space::H2).then(|| self.place(space).name()),
            metric: text(&args.metric),
            uv: text(&args.uv),
            on: args.on,
            sphere: text(&args.sphere),
            generators: text(&args.generators),
            picture: args.picture.clone(),
            texture: args.texture.or(drawn.then_some(Texture::Checker)),
            show: drawn.then_some(match shown {
                Shown::Uniform(show) => Show::Uniform(show),
                Shown::Cover(show) => Show::Cover(show),
            }),
            cover: self.cover.map(|c| CoverAsked {
                depth: c.radius.is_none().then_some(c.depth),
                radius: c.radius,
                limit: c.limit,
                cover: c.cover.map(path_text),
                domain: c.domain.map(path_text),
            }),
        }
    }
}

#[derive(Serialize)]
pub struct Asked {
    weld: Option<f64>,
    input_geometry: &'static str,
    scheme: SchemeChoice,
    method: MethodChoice,
    flips: FlipsChoice,
    tolerance: f64,
    max_iterations: usize,
    threads: usize,
    /// The base vertex; of a sphere the one at infinity, if one was asked for.
    base: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    metric: Option<String>,
    uv: Option<String>,
    on: OnChoice,
    sphere: Option<String>,
    generators: Option<String>,
    #[serde(flatten)]
    picture: PictureArgs,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<Texture>,
    #[serde(skip_serializing_if = "Option::is_none")]
    show: Option<Show>,
    #[serde(flatten)]
    cover: Option<CoverAsked>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Show {
    Uniform(ShowChoice),
    Cover(TilesChoice),
}

#[derive(Serialize)]
struct CoverAsked {
    depth: Option<usize>,
    radius: Option<f64>,
    limit: usize,
    cover: Option<String>,
    domain: Option<String>,
}

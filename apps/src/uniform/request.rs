//! What is asked of the commands, and what they refuse.

use super::args::{CanonicalArgs, CoverArgs, ModelChoice, ShowChoice, Shown, TilesChoice};
use super::boundary::BoundaryChoice;
use super::model_place::ModelPlace;
use super::needs::Needs;
use super::outline::touching;
use super::quotient::Uniformized;
use crate::failure::Failure;
use crate::input::Input;
use crate::options::{FileName, FlipsChoice, MethodChoice, OnChoice, SchemeChoice};
use crate::output::{check_extension, check_outputs};
use crate::picture::TextureChoice;
use ricci::Control;
use ricci::embed::cover::{elements_to_depth, elements_within};
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use serde::Serialize;

/// Copies to make, and where they are written.
#[derive(Serialize, Clone, Copy)]
pub struct CoverWish<'a> {
    /// None, as the radius is: every copy that touches the domain.
    pub depth: Option<u16>,
    pub radius: Option<f64>,
    pub limit: u32,
    pub cover: Option<&'a FileName>,
    pub domain: Option<&'a FileName>,
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
    pub fn new(args: &CoverArgs) -> CoverWish<'_> {
        let CoverArgs { depth, radius, limit, .. } = *args;
        CoverWish { depth, radius, limit, cover: args.cover.as_ref(), domain: args.domain.as_ref() }
    }

    /// Find the copies that are asked for. Where there are too many, or no domain to find them by, files that show none are written all
    /// the same. Errors: [`Failure::Cancelled`] alone.
    pub fn find(&self, u: &mut Uniformized, control: &Control) -> Result<(), Failure> {
        let limit = self.limit as usize;
        let found = match (self.depth, self.radius.map(|radius| (radius, u.domain()))) {
            (Some(depth), _) => elements_to_depth(&u.deck, depth.into(), limit, control),
            (None, None) => touching(u, limit, control),
            (_, Some((radius, Ok(domain)))) => elements_within(&u.deck, domain, radius, limit, control),
            (_, Some((_, Err(why)))) => Err(ricci::Error::Layout(format!("{why}; use --depth"))),
        };
        let option = if self.depth.is_some() { "depth" } else { "radius" };
        u.elements = match found {
            Ok(elements) => Ok(elements),
            Err(ricci::Error::Cancelled) => return Err(Failure::Cancelled),
            Err(ricci::Error::TooLarge { .. }) => {
                Err(format!("more than {} copies; lower --{option} or raise --limit", self.limit))
            }
            Err(error) => Err(error.to_string()),
        };
        if let Err(why) = &u.elements {
            u.solved.failed.0.insert(option, why.clone());
        }
        Ok(())
    }
}

impl Wish<'_> {
    /// What the outputs that are asked for are made from.
    pub fn needs(&self, input: &Input, shown: Shown) -> Needs {
        let (report, drawn) = (self.args.to.common.report.is_some(), self.args.picture.picture.is_some());
        let of_domain = matches!(
            shown,
            Shown::Uniform(
                ShowChoice::Both | ShowChoice::Surface | ShowChoice::Polygon | ShowChoice::Dirichlet
            ) | Shown::Cover(TilesChoice::Tiles)
        );
        let by_domain = self.cover.is_some_and(|c| c.depth.is_none() || c.domain.is_some());
        let copies = self.cover.is_some_and(|c| c.cover.is_some());
        Needs {
            refinement: report || drawn || copies || self.args.to.uv.is_some(),
            on_input: self.args.to.on == OnChoice::Input && self.args.to.uv.is_some(),
            domain: (report || by_domain || (drawn && of_domain)) && !self.args.boundary.has_corners(input),
        }
    }

    /// What can be refused before anything is read.
    pub fn check_request(&self) -> Result<(), Failure> {
        let args = self.args;
        let cover = self.cover.as_ref();
        let [copies, domain] =
            [cover.and_then(|c| c.cover), cover.and_then(|c| c.domain)].map(|file| file.map(|name| &**name));
        let meshes =
            [("--uv", args.to.uv.as_deref()), ("--sphere", args.sphere.as_deref()), ("--cover", copies)];
        for (option, path) in meshes {
            check_extension(option, path, &["obj", "glb"])?;
        }
        let picture = args.picture.picture.as_deref();
        check_extension("--picture", picture, &["png", "svg"])?;
        let in_space = matches!(self.shown, Some(Shown::Uniform(ShowChoice::Both | ShowChoice::Surface)));
        if in_space && args.picture.is_svg() {
            return Err(Failure::Usage(
                "--picture: an SVG shows no surface in space; use .png, or --show domain".into(),
            ));
        }
        if args.picture.is_svg() && args.picture.is_turned() {
            return Err(Failure::Usage(
                "--view, --up: an SVG shows no surface in space; use .png, or leave them out".into(),
            ));
        }
        let files = [
            args.to.metric.as_deref(),
            args.to.uv.as_deref(),
            args.to.xref.as_deref(),
            args.sphere.as_deref(),
            args.generators.as_deref(),
            picture,
            args.to.common.report.as_deref(),
            copies,
            domain,
        ];
        check_outputs(&[Some(&args.to.surface.file.mesh)], &files)
    }

    /// What can be refused once the surface is known; what the picture shows.
    pub fn check_surface(&self, input: &Input) -> Result<Shown, Failure> {
        let mesh = input.mesh();
        self.args.boundary.check(input)?;
        if mesh.euler() > 1 {
            return self.check_sphere(input);
        }
        let (in_plane, has_corners) = (self.lies_in_plane(input), self.args.boundary.has_corners(input));
        if has_corners && self.cover.is_some() {
            return Err(Failure::Usage(
                "cover: a surface with corners does not tile the plane; use ricci uniformize, or --boundary geodesic".into(),
            ));
        }
        if self.args.sphere.is_some() {
            return Err(Failure::Usage(format!(
                "--sphere: a surface of genus {} is no sphere; use --uv",
                mesh.genus()
            )));
        }
        if self.model.is_some() && in_plane {
            return Err(Failure::Usage(
                "--model: the surface lies in the plane, which has no other model".into(),
            ));
        }
        let beside = input.positions().is_some() && !self.args.picture.is_svg();
        let usual = match (beside, has_corners) {
            (true, _) => ShowChoice::Both,
            (_, true) => ShowChoice::Domain,
            _ => ShowChoice::Dirichlet,
        };
        let shown = self.shown.unwrap_or(Shown::Uniform(usual));
        if let (true, Shown::Uniform(ShowChoice::Dirichlet | ShowChoice::Polygon)) = (has_corners, shown) {
            return Err(Failure::Usage("--show: with corners there is the layout alone; use domain".into()));
        }
        if input.positions().is_none() {
            let nothing = "an intrinsic metric has no positions in space";
            if self.args.to.uv.is_some() {
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

    /// Whether the metric of the surface is flat.
    fn lies_in_plane(&self, input: &Input) -> bool {
        input.mesh().euler() == 0
            || !input.mesh().is_closed() && self.args.boundary.choice() == BoundaryChoice::Straight
    }

    /// The same for a sphere.
    fn check_sphere(&self, input: &Input) -> Result<Shown, Failure> {
        let (args, usage) = (self.args, |message: &str| Err(Failure::Usage(message.into())));
        if args.to.uv.is_some() {
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
        if args.to.solve.method == MethodChoice::Newton {
            if input.mesh().n_vertices() < 4 {
                let path = input.path.display();
                let why =
                    "a sphere of fewer than four vertices is no polyhedron; cut each triangle into four";
                return Err(Failure::Input(format!("{path}: {why}")));
            }
            if !matches!(args.to.solve.scheme, SchemeChoice::Yamabe) {
                return usage(
                    "--scheme: spheres flow by vertex scaling, yamabe; other schemes with --method gradient",
                );
            }
            if matches!(args.to.solve.flips, FlipsChoice::Never) {
                return usage("--flips never: spheres flip edges; without flips use --method gradient");
            }
        }
        if args.picture.is_svg() {
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
    pub fn asked(&self, input: &Input, base: Option<u32>, shown: Shown) -> Asked<'_> {
        let args = self.args;
        let drawn = args.picture.picture.is_some();
        Asked {
            input_geometry: input.surface.geometry().name(),
            max_iterations: args.to.options().iteration_limit(),
            base,
            model: (!self.lies_in_plane(input) && input.mesh().euler() < 0)
                .then(|| self.place(Space::H2).name()),
            boundary: (!input.mesh().is_closed()).then(|| self.args.boundary.choice()),
            texture: args.texture.or(drawn.then_some(TextureChoice::Checker)),
            show: drawn.then_some(shown),
            args,
            cover: self.cover,
        }
    }
}

#[derive(Serialize)]
pub struct Asked<'a> {
    input_geometry: &'static str,
    max_iterations: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    boundary: Option<BoundaryChoice>,
    /// The base vertex; of a sphere the one at infinity, if one was asked for.
    base: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<TextureChoice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    show: Option<Shown>,
    #[serde(flatten)]
    args: &'a CanonicalArgs,
    #[serde(flatten)]
    cover: Option<CoverWish<'a>>,
}

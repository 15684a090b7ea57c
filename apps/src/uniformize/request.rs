//! The requests of `ricci uniformize` and `ricci cover`, and what they refuse.

use super::args::{
    CanonicalArgs, CanonicalPictureChoice, CoverArgs, CoverPictureChoice, ModelChoice, UniformPictureChoice,
    UniformizeArgs,
};
use super::boundary::BoundaryChoice;
use super::model_place::ModelPlace;
use super::outline::touching;
use super::quotient::Uniformized;
use super::task::OutputNeeds;
use crate::failure::{Failure, NO_POSITIONS};
use crate::input::Input;
use crate::modulus::ModulusArgs;
use crate::options::{FileName, FlipsChoice, MethodChoice, OnChoice, SchemeChoice};
use crate::output::{check_extension, check_outputs};
use crate::picture::TextureChoice;
use crate::runner::CommandRun;
use ricci::embed::cover::{elements_to_depth, elements_within};
use ricci::geometry::Space;
use ricci::geometry::model::Model;
use serde::Serialize;

/// The copies to make, and the files that show them.
#[derive(Serialize, Clone, Copy)]
pub struct CoverRequest<'a> {
    /// With neither a depth nor a radius every copy that touches the domain is made.
    pub depth: Option<u16>,
    pub radius: Option<f64>,
    pub limit: u32,
    pub cover: Option<&'a FileName>,
    pub domain: Option<&'a FileName>,
    /// Words of loops to lift.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    pub words: &'a [String],
    /// The file of loops to lift.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift: Option<&'a FileName>,
    /// The file of lifted loops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift_out: Option<&'a FileName>,
}

/// The arguments of either command; a report of a failure has those that both share.
#[derive(Serialize)]
pub struct CanonicalJob<'a> {
    #[serde(flatten)]
    pub args: &'a CanonicalArgs,
    #[serde(skip)]
    pub command: &'static str,
    #[serde(skip)]
    pub shown: Option<CanonicalPictureChoice>,
    #[serde(skip)]
    pub model: Option<ModelChoice>,
    #[serde(skip)]
    pub cover: Option<CoverRequest<'a>>,
    /// What is told of the modulus, by `ricci uniformize`.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub modulus: Option<&'a ModulusArgs>,
}

impl CoverRequest<'_> {
    pub fn new(args: &CoverArgs) -> CoverRequest<'_> {
        let CoverArgs { depth, radius, limit, .. } = *args;
        CoverRequest {
            depth,
            radius,
            limit,
            cover: args.cover.as_ref(),
            domain: args.domain.as_ref(),
            words: &args.words,
            lift: args.lift.as_ref(),
            lift_out: args.lift_out.as_ref(),
        }
    }

    /// True if loops are to be lifted.
    pub fn lifts_loops(&self) -> bool {
        !self.words.is_empty() || self.lift.is_some()
    }

    /// Find the copies that are asked for. Where there are too many, or no domain to find them by, the files that show no copies are written
    /// all the same.
    ///
    /// # Errors
    /// [`Failure::Cancelled`] alone.
    pub fn find(&self, u: &mut Uniformized, run: &mut CommandRun<'_>) -> Result<(), Failure> {
        let (limit, control) = (self.limit as usize, run.control);
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
            run.failed.0.insert(option, why.clone());
        }
        Ok(())
    }
}

impl<'a> From<&'a UniformizeArgs> for CanonicalJob<'a> {
    fn from(args: &'a UniformizeArgs) -> Self {
        let shown = args.show.map(CanonicalPictureChoice::Uniform);
        CanonicalJob {
            args: &args.canonical,
            command: "uniformize",
            shown,
            model: args.model,
            cover: None,
            modulus: Some(&args.modulus),
        }
    }
}

impl<'a> From<&'a CoverArgs> for CanonicalJob<'a> {
    fn from(args: &'a CoverArgs) -> Self {
        let cover = Some(CoverRequest::new(args));
        let shown = args.show.unwrap_or(CoverPictureChoice::Tiles);
        let shown = Some(CanonicalPictureChoice::Cover(shown));
        CanonicalJob {
            args: &args.canonical,
            command: "cover",
            shown,
            model: args.model,
            cover,
            modulus: None,
        }
    }
}

impl CanonicalJob<'_> {
    /// The results that the outputs which are asked for need.
    pub fn needs(&self, input: &Input, shown: CanonicalPictureChoice) -> OutputNeeds {
        let (report, drawn) = (self.args.to.common.report.is_some(), self.args.picture.picture.is_some());
        let of_domain = matches!(
            shown,
            CanonicalPictureChoice::Uniform(
                UniformPictureChoice::Both
                    | UniformPictureChoice::Surface
                    | UniformPictureChoice::Polygon
                    | UniformPictureChoice::Dirichlet
            ) | CanonicalPictureChoice::Cover(CoverPictureChoice::Tiles)
        );
        let by_domain = self.cover.is_some_and(|c| c.depth.is_none() || c.domain.is_some());
        let copies = self.cover.is_some_and(|c| c.cover.is_some() || c.lift.is_some());
        let laid = self.args.to.uv.is_some() || self.args.to.flat.flat.is_some();
        OutputNeeds {
            subdivision: report || drawn || copies || laid,
            on_input: self.args.to.on == OnChoice::Input && laid,
            domain: (report || by_domain || (drawn && of_domain)) && !self.args.boundary.has_corners(input),
        }
    }

    /// Refuse what can be refused before anything is read.
    pub fn check_request(&self) -> Result<(), Failure> {
        let args = self.args;
        args.to.check_faces()?;
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
        args.to.flat.check()?;
        let in_space = matches!(
            self.shown,
            Some(CanonicalPictureChoice::Uniform(UniformPictureChoice::Both | UniformPictureChoice::Surface))
        );
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
        let lifted = cover.and_then(|c| c.lift_out);
        if lifted.is_some() && !cover.is_some_and(CoverRequest::lifts_loops) {
            return Err(Failure::Usage(
                "--lift-out: say which loops to lift, --word 'a1 b1^-1' or --lift L.csv".into(),
            ));
        }
        let files = [
            lifted.map(|name| &**name),
            args.to.metric.as_deref(),
            args.to.uv.as_deref(),
            args.to.xref.as_deref(),
            args.to.flat.flat.as_deref(),
            args.sphere.as_deref(),
            args.generators.as_deref(),
            self.modulus.and_then(|modulus| modulus.bounds.as_deref()),
            picture,
            args.to.common.report.as_deref(),
            copies,
            domain,
        ];
        let loops = cover.and_then(|c| c.lift).map(|name| &**name);
        check_outputs(&[Some(&args.to.surface.file.mesh), loops], &files)
    }

    /// Refuse what can be refused once the surface is known; returns the contents of the picture.
    pub fn check_surface(&self, input: &Input) -> Result<CanonicalPictureChoice, Failure> {
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
        if self.args.to.flat.flat.is_some() && !in_plane {
            return Err(Failure::Usage(
                "--flat: the layout lies in the hyperbolic plane, which is not flat; --uv has its Poincaré disk, `ricci flow --target auto:8 \
                 --flat` is flat with cones"
                    .into(),
            ));
        }
        self.args.to.flat.check_surface(input)?;
        if self.model.is_some() && in_plane {
            return Err(Failure::Usage(
                "--model: the surface lies in the plane, which has no other model".into(),
            ));
        }
        let beside = input.positions().is_some() && !self.args.picture.is_svg();
        let usual = match (beside, has_corners) {
            (true, _) => UniformPictureChoice::Both,
            (_, true) => UniformPictureChoice::Domain,
            _ => UniformPictureChoice::Dirichlet,
        };
        let shown = self.shown.unwrap_or(CanonicalPictureChoice::Uniform(usual));
        if let (
            true,
            CanonicalPictureChoice::Uniform(UniformPictureChoice::Dirichlet | UniformPictureChoice::Polygon),
        ) = (has_corners, shown)
        {
            return Err(Failure::Usage("--show: with corners there is the layout alone; use domain".into()));
        }
        if input.positions().is_none() {
            if self.args.to.uv.is_some() {
                let way = if in_plane { "--flat" } else { "`ricci cover --depth 0 --cover`" };
                return Err(Failure::Usage(format!("--uv: {NO_POSITIONS}; {way} OUT.obj writes the layout")));
            }
            if let CanonicalPictureChoice::Uniform(
                UniformPictureChoice::Both | UniformPictureChoice::Surface,
            ) = shown
            {
                return Err(Failure::Usage(format!("--show: {NO_POSITIONS}; use domain")));
            }
        }
        Ok(shown)
    }

    /// True if the metric of the surface is flat.
    fn lies_in_plane(&self, input: &Input) -> bool {
        input.mesh().euler() == 0
            || !input.mesh().is_closed() && self.args.boundary.choice() == BoundaryChoice::Straight
    }

    /// [`CanonicalJob::check_surface`] for a sphere.
    fn check_sphere(&self, input: &Input) -> Result<CanonicalPictureChoice, Failure> {
        let (args, usage) = (self.args, |message: &str| Err(Failure::Usage(message.into())));
        if args.to.uv.is_some() {
            return usage("--uv: a sphere lies in no plane; use --sphere S.obj (or ricci flow, with cones)");
        }
        if args.to.flat.flat.is_some() {
            return usage(
                "--flat: a sphere lies in no plane; use --sphere S.obj (or ricci flow --flat, with cones)",
            );
        }
        if self.model.is_some() {
            return usage("--model: a sphere is not in the hyperbolic plane");
        }
        if self.cover.is_some_and(|c| c.domain.is_some()) {
            return usage(
                "--domain: a sphere is its own universal cover; there is no fundamental domain to write",
            );
        }
        if self.cover.is_some_and(|c| c.lifts_loops()) {
            return usage(
                "--word, --lift: a sphere is its own universal cover, where every loop stays closed",
            );
        }
        if args.to.solve.method == MethodChoice::Newton {
            if input.mesh().n_vertices() < 4 {
                let path = input.path.display();
                let why = "a sphere of fewer than four vertices is no polyhedron; cut each triangle into four, `ricci refine --levels 1`";
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
            None | Some(CanonicalPictureChoice::Cover(_)) => {
                Ok(CanonicalPictureChoice::Uniform(UniformPictureChoice::Both))
            }
            Some(shown @ CanonicalPictureChoice::Uniform(UniformPictureChoice::Both)) => Ok(shown),
            Some(shown @ CanonicalPictureChoice::Uniform(UniformPictureChoice::Surface))
                if input.positions().is_some() =>
            {
                Ok(shown)
            }
            Some(_) => usage("--show: a sphere has no fundamental domain; use both"),
        }
    }

    /// The model of the space in which copies are written.
    pub fn place(&self, space: Space) -> ModelPlace {
        ModelPlace::new(space, self.model.map_or(Model::Poincare, Model::from))
    }

    /// The model of the space in which pictures are drawn: for the hyperboloid the Poincaré disk, which is its projection.
    pub fn drawn_place(&self, space: Space) -> ModelPlace {
        let drawn = self.model.filter(|model| *model != ModelChoice::Hyperboloid);
        ModelPlace::new(space, drawn.map_or(Model::Poincare, Model::from))
    }

    /// The options of a run as its report has them. `base`: the base vertex; of a sphere the one at infinity, if one was asked for.
    pub fn settings_of(
        &self,
        input: &Input,
        base: Option<u32>,
        shown: CanonicalPictureChoice,
    ) -> CanonicalSettings<'_> {
        let args = self.args;
        let drawn = args.picture.picture.is_some();
        CanonicalSettings {
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
            modulus: self.modulus,
        }
    }
}

#[derive(Serialize)]
pub struct CanonicalSettings<'a> {
    input_geometry: &'static str,
    max_iterations: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    boundary: Option<BoundaryChoice>,
    base: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    texture: Option<TextureChoice>,
    #[serde(skip_serializing_if = "Option::is_none")]
    show: Option<CanonicalPictureChoice>,
    #[serde(flatten)]
    args: &'a CanonicalArgs,
    #[serde(flatten)]
    cover: Option<CoverRequest<'a>>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    modulus: Option<&'a ModulusArgs>,
}

//! The picture of a surface in space, with light and shadow.

use super::camera::Camera;
use super::coat::{Coat, PanelContent};
use super::color::{INK, Rgb, cone_color, mix, seam_color};
use super::fit::Fit;
use super::light::Lights;
use super::normals::corner_normals;
use super::occlusion::{Ground, LightField, ReceivedLight, SeenPoint, ShadowCaster, over};
use super::raster::{DrawnShape, Hit, PixelImage, render};
use super::region::border;
use super::vector::{V3, add, at, bounding_ball, dot, norm, normal, scaled, sub, unit};
use super::{ShownSurface, Style, Viewpoint};

/// The sine of the lowest elevation of the camera from which the ground is shown.
const LOWEST: f64 = 0.1;
/// Share of the shadow's length that the picture has room for.
const SHADOW: f64 = 0.5;
/// Room for the shade beside and below a surface that stands on the ground, over its radius.
const ROOM: f64 = 0.12;
/// Width of the border in which the ground fades to white, over the picture's size.
const FADE: f64 = 0.16;
/// The ground also fades between these distances from the point below the surface's middle, over the surface's radius.
const REACH: [f64; 2] = [0.9, 2.2];
/// The direction that counts as up for the light on a part of a surface: up on the screen and towards the viewer.
const FOCUS_UP: V3 = [0.0, -0.8, 0.6];
/// The tint of the inside of a surface.
const INSIDE: Rgb = [0.5, 0.18, 0.08];

/// Draw a surface with its light and shadows.
pub fn draw(surface: &ShownSurface<'_>, wish: &PanelContent<'_>, style: &Style) -> PixelImage {
    let finite = |p: &V3| p.iter().all(|x| x.is_finite());
    if surface.positions.is_empty() || !surface.positions.iter().all(finite) {
        return PixelImage::white(style.size, style.size);
    }
    let scene = LitScene::new(surface, wish, style);
    render(&scene.shapes, scene.size, |pixel, hit| scene.paint(pixel, hit))
}

/// The shapes of a panel with the colouring, the lights and the shadows of their points.
struct LitScene<'a> {
    /// The faces, then seams, boundary and cones.
    shapes: Vec<DrawnShape>,
    size: [usize; 2],
    corners: Vec<[V3; 3]>,
    normals: Vec<[V3; 3]>,
    coat: Coat<'a>,
    /// Colours of the shapes after the faces.
    strokes: Vec<Rgb>,
    lights: Lights,
    ground: Option<Ground>,
    /// None in a draft, which has no shadows.
    caster: Option<ShadowCaster>,
    field: Option<LightField>,
    /// Width in pixels over which the ground fades at the edge.
    margin: f64,
    /// The point of the ground below the surface's middle, and the surface's radius.
    foot: (V3, f64),
}

/// A surface as the camera sees it.
struct CameraView {
    camera: Camera,
    lights: Lights,
    fit: Fit,
    /// Positions in pixels.
    placed: Vec<V3>,
    ground: Option<Ground>,
}

impl CameraView {
    /// `points`: scaled by `factor`.
    fn new(points: &[V3], faces: &[[u32; 3]], style: &Style, factor: f64) -> CameraView {
        let view = Viewpoint { from: style.focus.map(|focus| focus.normal), ..style.view };
        let camera = Camera::choose(points, faces, &view);
        // A part of the surface is lit as seen, wherever it faces.
        let up = match style.focus {
            None => [camera.up[0], -camera.up[1], camera.up[2]],
            Some(_) => FOCUS_UP,
        };
        let lights = Lights::new(up);
        let seen: Vec<V3> = points.iter().map(|p| camera.apply(*p)).collect();
        // The picture has room for the shadow on the ground, if there is one.
        let height = |p: &V3| dot(camera.up, *p);
        let lowest = seen.iter().map(height).fold(f64::INFINITY, f64::min);
        let has_ground = style.ground && style.focus.is_none() && camera.up[2] > LOWEST;
        let key = [lights.key[0], -lights.key[1], lights.key[2]];
        let shadow = |p: &V3| {
            let fall = (height(p) - lowest) / dot(camera.up, key);
            add(*p, scaled(key, -SHADOW * fall))
        };
        let shadows = seen.iter().filter(|_| has_ground).map(shadow);
        let room = if has_ground { ROOM * bounding_ball(&seen).1 } else { 0.0 };
        let with_room = |[x, y, _]: V3| [[x - room, y - room], [x + room, y]];
        let fit = match &style.focus {
            None => Fit::new(seen.iter().copied().chain(shadows).flat_map(with_room), style.size),
            Some(focus) => {
                let [x, y, _] = camera.apply(scaled(focus.at, factor));
                Fit::around([x, y], focus.radius * factor, style.size)
            }
        };
        let pixel = |p: &V3| {
            let [x, y] = fit.apply([p[0], p[1]]);
            [x, y, fit.scale * p[2]]
        };
        let placed: Vec<V3> = seen.iter().map(pixel).collect();
        let level = placed.iter().map(|p| dot(up, *p)).fold(f64::INFINITY, f64::min);
        let ground = has_ground.then_some(Ground { up, level });
        CameraView { camera, lights, fit, placed, ground }
    }
}

impl<'a> LitScene<'a> {
    fn new(surface: &ShownSurface<'_>, wish: &PanelContent<'a>, style: &Style) -> LitScene<'a> {
        // Scaled, so that products of tiny coordinates do not underflow, nor those of huge ones overflow.
        let most = surface.positions.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let factor = if most > 0.0 { 1.0 / most } else { 1.0 };
        let points: Vec<V3> = surface.positions.iter().map(|p| scaled(*p, factor)).collect();
        let CameraView { camera, lights, fit, placed, ground } =
            CameraView::new(&points, surface.faces, style, factor);
        let turned = |n: V3| {
            let [x, y, z] = camera.apply(n);
            [x, -y, z]
        };
        let corners: Vec<[V3; 3]> = surface.faces.iter().map(|f| f.map(|v| placed[v as usize])).collect();
        let normals: Vec<[V3; 3]> =
            corner_normals(&points, surface.faces).into_iter().map(|n| n.map(turned)).collect();
        let flat: Vec<[[f64; 2]; 3]> = corners.iter().map(|c| c.map(|p| [p[0], p[1]])).collect();
        let mut shapes: Vec<DrawnShape> = corners.iter().map(|c| DrawnShape::Triangle(*c)).collect();
        let cast = || ShadowCaster::new(&placed, surface.faces, lights.key);
        let caster = (!style.draft).then(cast);
        let mut strokes = Vec::new();
        let mut tube = |a: u32, b: u32, radius: f64, color: Rgb| {
            let ends = [placed[a as usize], placed[b as usize]];
            shapes.push(DrawnShape::Capsule { ends, radius });
            strokes.push(color);
        };
        let border = if surface.is_closed { Vec::new() } else { border(surface.faces.iter().copied()) };
        border.into_iter().for_each(|(a, b)| tube(a, b, style.line(), INK));
        surface.seams.iter().for_each(|&(a, b, seam)| tube(a, b, 1.5 * style.line(), seam_color(seam)));
        surface.cones.iter().for_each(|&(v, curvature)| tube(v, v, style.cone(), cone_color(curvature)));
        let (middle, radius) = bounding_ball(&placed);
        let foot = ground.map_or(middle, |g| add(middle, scaled(g.up, g.level - dot(g.up, middle))));
        let mut scene = LitScene {
            foot: (foot, radius),
            size: [fit.width, fit.height],
            coat: Coat::new(wish, style, &flat),
            margin: FADE * style.size as f64,
            shapes,
            corners,
            normals,
            strokes,
            lights,
            ground,
            caster,
            field: None,
        };
        let faces = &scene.shapes[..scene.corners.len()];
        let describe = |at, hit: Option<&Hit>| scene.describe(at, hit);
        let light = |caster| LightField::new(caster, faces, scene.size, describe);
        scene.field = scene.caster.as_ref().map(light);
        scene
    }

    /// The point of a face, or of the ground behind it all.
    fn describe(&self, pixel: [f64; 2], hit: Option<&Hit>) -> Option<SeenPoint> {
        let Some(hit) = hit else { return self.ground.map(|g| g.below(pixel)) };
        let (corners, normals) = (self.corners[hit.shape], self.normals[hit.shape]);
        let toward = |n: V3| if hit.front { n } else { scaled(n, -1.0) };
        let smooth = unit(at(hit.local, normals)).map(toward);
        // The panel is a mirror image of space, so the order of the corners turns the normal around.
        let flat = unit(normal(corners)).map(|n| if n[2] < 0.0 { scaled(n, -1.0) } else { n });
        let flat = flat.or(smooth).unwrap_or([0.0, 0.0, 1.0]);
        let xyz = over(hit.local, corners, normals.map(toward));
        Some(SeenPoint { xyz, normal: smooth.unwrap_or(flat), flat, on_ground: false })
    }

    /// The strength of the ground's shadows: 1 near the surface, 0 at the border of the panel and far from the surface.
    fn fade(&self, pixel: [f64; 2], below: &SeenPoint) -> f64 {
        let smooth = |t: f64| t.clamp(0.0, 1.0).powi(2) * (3.0 - 2.0 * t.clamp(0.0, 1.0));
        let edge = |k: usize| smooth(pixel[k].min(self.size[k] as f64 - pixel[k]) / self.margin);
        let (foot, radius) = self.foot;
        let far = norm(sub(below.xyz, foot)) / radius;
        edge(0) * edge(1) * smooth((REACH[1] - far) / (REACH[1] - REACH[0]))
    }

    /// The light at a point that a pixel shows, from the field of light or else from the shadow maps.
    fn open(&self, pixel: [f64; 2], point: &SeenPoint) -> ReceivedLight {
        let near = self.field.as_ref().and_then(|field| field.at(pixel, point));
        near.unwrap_or_else(|| self.caster.as_ref().map_or(ReceivedLight::FULLY, |caster| caster.open(point)))
    }

    /// The colour of a place of a shape, or of the background.
    fn paint(&self, pixel: [f64; 2], hit: Option<&Hit>) -> Rgb {
        let Some(hit) = hit else {
            let Some(ground) = &self.ground else { return [1.0; 3] };
            let below = ground.below(pixel);
            let shade = Lights::on_ground(self.open(pixel, &below));
            return mix([1.0; 3], shade, self.fade(pixel, &below));
        };
        if hit.shape < self.corners.len() {
            let Some(point) = self.describe(pixel, Some(hit)) else { return [1.0; 3] };
            let albedo = self.coat.color(hit.shape, hit.local);
            let albedo = if hit.front { albedo } else { mix(albedo, INSIDE, 0.45) };
            return self.lights.on(albedo, point.normal, self.open(pixel, &point));
        }
        // Tubes and balls are marks on the surface: lit, but not shaded by it.
        self.lights.on(self.strokes[hit.shape - self.corners.len()], hit.local, ReceivedLight::FULLY)
    }
}

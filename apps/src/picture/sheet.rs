//! A sheet with images, and with vectors over them as SVG, which resvg turns into pixels.

use super::color::{INK, Rgb, to_hex};
use super::raster::PixelImage;
use super::region::is_finite;
use crate::failure::Failure;
use resvg::tiny_skia::{PixmapMut, Transform};
use resvg::usvg;
use std::fmt::Write;

/// Opacity in SVG over that in linear light: SVG mixes sRGB values, in which thin lines look darker.
const WIRE: f64 = 0.65;

/// A drawing in pixels, y down.
#[derive(Default)]
pub struct VectorSheet {
    pub width: usize,
    pub height: usize,
    images: Vec<(PixelImage, [usize; 2])>,
    vectors: String,
}

/// Lines and curves: the data of an SVG path.
#[derive(Default, Clone)]
pub struct SvgPath(String);

impl SvgPath {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// A command with its points, to a hundredth of a pixel.
    pub fn command(&mut self, command: char, points: &[[f64; 2]]) {
        let numbers: Vec<String> = points.as_flattened().iter().map(|x| decimal(*x)).collect();
        self.0.push(command);
        self.0 += &numbers.join(" ");
    }

    /// A line through points, by relative steps; one with a point that is not finite is left out.
    pub fn line(&mut self, points: &[[f64; 2]]) {
        if points.len() < 2 || !is_finite(points) {
            return;
        }
        let places: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| (100.0 * x).round())).collect();
        let step = |w: &[[f64; 2]]| [0, 1].map(|k| (w[1][k] - w[0][k]) / 100.0);
        self.command('M', &[places[0].map(|x| x / 100.0)]);
        self.command('l', &places.windows(2).map(step).collect::<Vec<_>>());
    }

    pub fn polygon(&mut self, points: &[[f64; 2]]) {
        let before = self.0.len();
        self.line(points);
        if self.0.len() > before {
            self.command('Z', &[]);
        }
    }

    pub fn rectangle(&mut self, [x, y, width, height]: [f64; 4]) {
        self.polygon(&[[x, y], [x + width, y], [x + width, y + height], [x, y + height]]);
    }

    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64) {
        if [x, y, radius].iter().all(|v| v.is_finite()) {
            let [left, y, r, d] = [x - radius, y, radius, 2.0 * radius].map(decimal);
            let _ = write!(self.0, "M{left} {y}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z");
        }
    }
}

/// Several lines or polygons, each added by `add`.
pub fn paths(pieces: impl Iterator<Item = Vec<[f64; 2]>>, add: fn(&mut SvgPath, &[[f64; 2]])) -> SvgPath {
    let mut path = SvgPath::default();
    pieces.for_each(|points| add(&mut path, &points));
    path
}

impl VectorSheet {
    pub fn new(width: usize, height: usize) -> VectorSheet {
        VectorSheet { width: width.max(1), height: height.max(1), ..VectorSheet::default() }
    }

    /// A sheet with an image on all of it.
    pub fn of_image(image: PixelImage) -> VectorSheet {
        let mut sheet = VectorSheet::new(image.width, image.height);
        sheet.images.push((image, [0; 2]));
        sheet
    }

    /// Add a path with these attributes.
    pub fn add(&mut self, attributes: &str, path: &SvgPath) {
        if !path.is_empty() {
            let _ = writeln!(self.vectors, r#"<path {attributes} d="{}"/>"#, path.0);
        }
    }

    pub fn fill(&mut self, color: Rgb, path: &SvgPath) {
        self.add(&format!(r#"fill="{}""#, to_hex(color)), path);
    }

    pub fn stroke(&mut self, color: Rgb, width: f64, path: &SvgPath) {
        self.add(&format!(r#"stroke="{}" stroke-width="{}""#, to_hex(color), decimal(width)), path);
    }

    /// Add edges of a mesh, of this opacity in linear light.
    pub fn wire(&mut self, opacity: f64, width: f64, path: &SvgPath) {
        let (ink, width, opacity) = (to_hex(INK), decimal(width), decimal(WIRE * opacity));
        self.add(&format!(r#"stroke="{ink}" stroke-width="{width}" stroke-opacity="{opacity}""#), path);
    }

    /// Write letters that begin at a point. `halo`: the width of a white line around them. The text is their label for screen readers.
    pub fn write(&mut self, text: &str, letters: &SvgPath, ([x, y], color): ([f64; 2], Rgb), halo: f64) {
        let label = text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        let [x, y] = [x, y].map(decimal);
        let _ =
            writeln!(self.vectors, r#"<g role="img" aria-label="{label}" transform="translate({x} {y})">"#);
        if halo > 0.0 {
            self.stroke([1.0; 3], halo, letters);
        }
        self.fill(color, letters);
        self.vectors += "</g>\n";
    }

    /// Cut off the vectors beyond the sides; `id`: a name that no other sheet of the picture has.
    pub fn cut(mut self, id: &str) -> VectorSheet {
        let VectorSheet { width, height, vectors, .. } = &self;
        self.vectors = format!(
            r##"<clipPath id="{id}"><path d="M0 0H{width}V{height}H0Z"/></clipPath>
<g clip-path="url(#{id})">
{vectors}</g>
"##
        );
        self
    }

    /// Put another sheet on this one, its top left corner at (x, y).
    pub fn put(&mut self, other: VectorSheet, [x, y]: [usize; 2]) {
        let placed = other.images.into_iter().map(|(image, at)| (image, [at[0] + x, at[1] + y]));
        self.images.extend(placed);
        if !other.vectors.is_empty() {
            let _ = write!(self.vectors, "<g transform=\"translate({x} {y})\">\n{}</g>\n", other.vectors);
        }
    }

    fn text(&self, ground: &str) -> String {
        let VectorSheet { width, height, vectors, .. } = self;
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" fill="none" stroke-linejoin="round" stroke-linecap="round">
{ground}{vectors}</svg>
"#
        )
    }

    /// The vectors as a file, on a white ground.
    pub fn svg(&self) -> Vec<u8> {
        let VectorSheet { width, height, .. } = self;
        self.text(&format!("<path fill=\"white\" d=\"M0 0H{width}V{height}H0Z\"/>\n")).into_bytes()
    }

    /// The images on a white ground, and the vectors over them.
    pub fn image(self) -> Result<PixelImage, Failure> {
        let mut image = PixelImage::white(self.width, self.height);
        self.images.iter().for_each(|(part, [x, y])| image.put(part, *x, *y));
        if self.vectors.is_empty() {
            return Ok(image);
        }
        let failed = |why: String| Failure::Failed(format!("the picture cannot be drawn: {why}"));
        let tree = usvg::Tree::from_str(&self.text(""), &usvg::Options::default())
            .map_err(|e| failed(e.to_string()))?;
        let mut pixels = PixmapMut::from_bytes(&mut image.rgba, self.width as u32, self.height as u32)
            .ok_or_else(|| failed("it has too many pixels".into()))?;
        resvg::render(&tree, Transform::identity(), &mut pixels);
        Ok(image)
    }
}

/// Two decimals at most.
pub fn decimal(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!([1.0, -0.001, 12.345, 0.5].map(decimal), ["1", "0", "12.35", "0.5"]);
    }

    #[test]
    fn vectors_lie_over_images_and_end_with_their_sheet() {
        let mut part =
            VectorSheet::of_image(PixelImage { width: 4, height: 4, rgba: [0, 0, 0, 255].repeat(16) });
        let mut path = SvgPath::default();
        path.rectangle([2.0, 0.0, 100.0, 100.0]);
        part.fill([1.0, 0.0, 0.0], &path);
        let mut sheet = VectorSheet::new(10, 6);
        sheet.put(part.cut("part"), [1, 1]);
        let image = sheet.image().unwrap();
        let at = |x: usize, y: usize| image.rgba[4 * (10 * y + x)..][..3].to_vec();
        assert_eq!([at(0, 2), at(1, 1), at(3, 1), at(4, 4)], [[255; 3], [0; 3], [255, 0, 0], [255, 0, 0]]);
        assert_eq!([at(5, 2), at(4, 5)], [[255; 3]; 2]);
    }
}

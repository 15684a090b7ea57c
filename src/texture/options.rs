//! The options of [`super::texture_atlas()`].

use crate::error::{Error, Result};

/// Default of [`TextureOptions::stretch`].
pub const STRETCH: f64 = 1.3;
/// Default of [`TextureOptions::margin`].
pub const MARGIN: u32 = 2;
/// Default of [`TextureOptions::page`].
pub const PAGE: u32 = 1024;
/// Default of [`TextureOptions::fill`].
pub const FILL: f64 = 0.68;
/// The largest page, in texels along a side.
pub const LARGEST_PAGE: u32 = 1 << 16;

/// The options of [`super::texture_atlas()`].
#[derive(Debug, Clone, PartialEq)]
pub struct TextureOptions {
    /// The bound of the stretch, above 1: all but a hundredth of the area is to be stretched and compressed by less. A smaller bound makes
    /// longer seams. Default 1.3.
    pub stretch: f64,
    /// Least distance of two charts, in texels; half of it is left at the border of the page. Default 2, which keeps linear filters from mixing
    /// charts; mipmaps need more.
    pub margin: u32,
    /// Texels along a side of the page, a power of two. Default 1024.
    pub page: u32,
    /// The share of the page that charts are to fill, from 0 to 1: charts are divided along short paths as long as less is filled and the
    /// page gains from it. 0 divides no chart for that. Default 0.68.
    pub fill: f64,
    /// Texels for a unit of length on the model, and as many pages as that takes, up to 160; charts that are larger than a page are divided, and
    /// `fill` has no effect. 0 for one page, filled as far as it goes. Default 0.
    pub density: f64,
    /// The number of threads; 0: all. The result does not depend on it. Default 0.
    pub threads: usize,
}

impl Default for TextureOptions {
    fn default() -> Self {
        TextureOptions { stretch: STRETCH, margin: MARGIN, page: PAGE, fill: FILL, density: 0.0, threads: 0 }
    }
}

impl TextureOptions {
    /// # Errors
    /// [`Error::Argument`] for an option outside its range.
    pub(super) fn check(&self) -> Result<()> {
        if !(self.stretch > 1.0 && self.stretch.is_finite()) {
            return Err(Error::argument("stretch", self.stretch, "a number above 1"));
        }
        if !(self.page.is_power_of_two() && (16..=LARGEST_PAGE).contains(&self.page)) {
            return Err(Error::argument("page", self.page, "a power of two from 16 to 65536"));
        }
        if self.margin > self.page / 8 {
            return Err(Error::argument("margin", self.margin, "at most an eighth of the page"));
        }
        if !(0.0..=1.0).contains(&self.fill) {
            return Err(Error::argument("fill", self.fill, "from 0 to 1"));
        }
        if !(self.density >= 0.0 && self.density.is_finite()) {
            return Err(Error::argument("density", self.density, "a number of texels that is not negative"));
        }
        Ok(())
    }

    /// The same options for a model that is scaled by a factor.
    pub(super) fn for_scaled(&self, factor: f64) -> TextureOptions {
        TextureOptions { density: self.density / factor, ..self.clone() }
    }

    /// The density in texels of a page that has so many, which stand for those that are asked for.
    pub(super) fn scale(&self, texels: usize) -> f64 {
        self.density * texels as f64 / f64::from(self.page)
    }
}

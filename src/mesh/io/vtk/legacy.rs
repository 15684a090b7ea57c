//! Reader of legacy VTK files.

use super::legacy_file::LegacyFile;
use super::poly_data::{ArrayRole, PolyData, VtkArray};
use crate::error::Result;
use crate::mesh::io::Soup;
use crate::mesh::io::budget::Budget;
use crate::mesh::io::kind::NumberType;
use crate::mesh::io::polygon::Polygons;
use crate::mesh::io::scan::{Location, Quoted};

/// Parses a legacy VTK file of polygons, text or binary, of the versions 1 to 5.1: points, polygons and strips, and of the points normals,
/// texture coordinates, colours and arrays of one number; arrays of one number per polygon. Points and lines are left out. `path` is used in
/// errors.
///
/// # Errors
/// [`crate::Error::Parse`] with the byte.
pub fn parse_vtk(bytes: &[u8], path: &str) -> Result<Soup> {
    let mut file = LegacyFile { bytes, at: 0, path, is_binary: false };
    if !file.line().to_ascii_lowercase().starts_with("# vtk datafile") {
        return Location::whole(path)
            .error("this is no VTK file: its first line is not `# vtk DataFile Version …`".into());
    }
    file.line();
    let place = file.place();
    file.is_binary = match file.line().to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        other => return place.error(format!("{} is neither ASCII nor BINARY", Quoted(other))),
    };
    let mut reader =
        LegacyReader { data: PolyData { budget: Budget::of(bytes), ..PolyData::default() }, of: None };
    while let Some(word) = file.word() {
        let word = String::from_utf8_lossy(word).to_ascii_uppercase();
        reader.take(&word, &mut file)?;
    }
    reader.data.soup(Location::whole(path))
}

/// The elements that arrays belong to: their number, and whether they are points.
#[derive(Clone, Copy)]
struct ArrayOwners {
    count: usize,
    are_points: bool,
}

struct LegacyReader {
    data: PolyData,
    of: Option<ArrayOwners>,
}

impl LegacyReader {
    /// Takes the section that a word begins.
    fn take(&mut self, word: &str, file: &mut LegacyFile<'_>) -> Result<()> {
        let place = file.place();
        match word {
            "DATASET" => {
                let kind = file.text("the kind of the data set")?;
                if !kind.eq_ignore_ascii_case("POLYDATA") {
                    return place.error(format!("the data set is {}; POLYDATA is read", Quoted(&kind)));
                }
            }
            "POINTS" => {
                let (n, kind) = (file.count("the number of points")?, file.kind()?);
                let numbers =
                    file.numbers(kind, n.saturating_mul(3), "coordinates", &mut self.data.budget)?;
                self.data.budget.take(n, 24, "points", place)?;
                self.data.set_points(&numbers);
            }
            "POLYGONS" => self.cells(file)?,
            "TRIANGLE_STRIPS" => {
                let polygons = std::mem::take(&mut self.data.polygons);
                self.cells(file)?;
                let strips = std::mem::replace(&mut self.data.polygons, polygons);
                self.data.add_strips(strips, place)?;
            }
            "VERTICES" | "LINES" => {
                let polygons: Polygons = std::mem::take(&mut self.data.polygons);
                self.cells(file)?;
                self.data.polygons = polygons;
                self.data.has_others = true;
                self.data.leave_out(word.to_ascii_lowercase());
            }
            "POINT_DATA" | "CELL_DATA" => {
                let count = file.count("the number of elements")?;
                self.of = Some(ArrayOwners { count, are_points: word == "POINT_DATA" });
            }
            "METADATA" => file.skip_metadata(),
            _ => return self.array(word, file),
        }
        Ok(())
    }

    /// Polygons: each with its number of corners, or, from version 5.1 on, the ends of all and then the corners of all.
    fn cells(&mut self, file: &mut LegacyFile<'_>) -> Result<()> {
        let (count, size) = (file.count("the number of polygons")?, file.count("the number of corners")?);
        let place = file.place();
        let budget = &mut self.data.budget;
        budget.take(size, size_of::<u32>(), "corners", place)?;
        if !file.keyword("OFFSETS") {
            budget.take(count, size_of::<usize>(), "polygons", place)?;
            let numbers = file.numbers(NumberType::I32, size, "corners", budget)?;
            return self.data.add_counted(count, &numbers, place);
        }
        budget.take(count, size_of::<usize>(), "polygons", place)?;
        let kind = file.kind()?;
        let ends = file.numbers(kind, count, "ends of polygons", budget)?;
        let place = file.place();
        if !file.keyword("CONNECTIVITY") {
            return place.error("CONNECTIVITY has to follow OFFSETS".into());
        }
        let kind = file.kind()?;
        let corners = file.numbers(kind, size, "corners", budget)?;
        self.data.add_polygons(ends.get(1..).unwrap_or_default(), &corners, place)
    }

    /// An array of points or cells.
    fn array(&mut self, word: &str, file: &mut LegacyFile<'_>) -> Result<()> {
        let place = file.place();
        let count = self.of.map_or(0, |of| of.count);
        if word == "LOOKUP_TABLE" {
            file.text("the name of a table")?;
            let n = file.count("the number of colours")?;
            let kind = if file.is_binary { NumberType::U8 } else { NumberType::F32 };
            return file.numbers(kind, n.saturating_mul(4), "colours", &mut self.data.budget).map(drop);
        }
        if word == "FIELD" {
            return self.fields(file);
        }
        let known = [
            "SCALARS",
            "COLOR_SCALARS",
            "VECTORS",
            "NORMALS",
            "TEXTURE_COORDINATES",
            "TENSORS",
            "TENSORS6",
            "GLOBAL_IDS",
            "PEDIGREE_IDS",
        ];
        if !known.contains(&word) {
            return place.error(format!("{} begins no section that is read", Quoted(word)));
        }
        let name = file.text("the name of an array")?.into_owned();
        let (role, components, kind) = match word {
            "COLOR_SCALARS" => {
                let kind = if file.is_binary { NumberType::U8 } else { NumberType::F32 };
                (ArrayRole::Colors, file.count("the number of values")?, kind)
            }
            "TEXTURE_COORDINATES" => {
                (ArrayRole::TextureCoordinates, file.count("the number of coordinates")?, file.kind()?)
            }
            "NORMALS" => (ArrayRole::Normals, 3, file.kind()?),
            "VECTORS" => (ArrayRole::Plain, 3, file.kind()?),
            "TENSORS" => (ArrayRole::Plain, 9, file.kind()?),
            "TENSORS6" => (ArrayRole::Plain, 6, file.kind()?),
            "SCALARS" => (ArrayRole::Plain, 0, file.kind()?),
            _ => (ArrayRole::Plain, 1, file.kind()?),
        };
        let components = if word == "SCALARS" { scalars(file)? } else { components };
        let values = file.numbers(
            kind,
            count.saturating_mul(components),
            "numbers of an array",
            &mut self.data.budget,
        )?;
        self.put(VtkArray { name, role, components, kind, values });
        Ok(())
    }

    /// The arrays of a field, each with its own size.
    fn fields(&mut self, file: &mut LegacyFile<'_>) -> Result<()> {
        file.text("the name of a field")?;
        for _ in 0..file.count("the number of arrays")? {
            // Metadata of the array before.
            if file.keyword("METADATA") {
                file.skip_metadata();
            }
            let name = file.text("the name of an array")?.into_owned();
            let (components, rows) =
                (file.count("the number of components")?, file.count("the number of rows")?);
            let kind = file.kind()?;
            let values = file.numbers(
                kind,
                components.saturating_mul(rows),
                "numbers of an array",
                &mut self.data.budget,
            )?;
            self.put(VtkArray { name, role: ArrayRole::Plain, components, kind, values });
        }
        Ok(())
    }

    fn put(&mut self, array: VtkArray) {
        match self.of {
            Some(ArrayOwners { are_points: true, .. }) => self.data.at_points.push(array),
            Some(_) => self.data.at_cells.push(array),
            None => self.data.leave_out(format!("array {} of the data set", Quoted(&array.name))),
        }
    }
}

/// The number of components of scalars, which may be missing, and the name of their table.
fn scalars(file: &mut LegacyFile<'_>) -> Result<usize> {
    let place = file.place();
    let rest = file.line().into_owned();
    let components = match rest.trim() {
        "" => 1,
        number => place.count(Some(number), format_args!("number of components"))?,
    };
    if !file.keyword("LOOKUP_TABLE") {
        return file.place().error("LOOKUP_TABLE has to follow SCALARS".into());
    }
    file.text("the name of a table")?;
    Ok(components)
}

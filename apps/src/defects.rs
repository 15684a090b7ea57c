//! The defects of a mesh file as reports and summaries name them.

use crate::input;
use ricci::mesh::check::{Defect, Diagnosis};
use ricci::mesh::io::Soup;
use serde::Serialize;

/// The number of defects by kind, and all of them.
#[derive(Serialize, Clone)]
pub struct DefectList {
    #[serde(rename = "defect_counts")]
    pub counts: Vec<DefectCount>,
    #[serde(rename = "defects")]
    pub list: Vec<DefectFigures>,
}

#[derive(Serialize, Clone)]
pub struct DefectCount {
    pub code: &'static str,
    pub count: usize,
}

/// One defect; vertices and faces as the file numbers them, from 0.
#[derive(Serialize, Clone)]
pub struct DefectFigures {
    pub code: &'static str,
    pub message: Box<str>,
    pub vertices: Vec<u32>,
    pub faces: Vec<u32>,
    pub remedy: &'static str,
}

impl From<&Defect> for DefectFigures {
    fn from(defect: &Defect) -> Self {
        DefectFigures {
            code: defect.code(),
            message: defect.to_string().into(),
            vertices: defect.vertices(),
            faces: defect.faces(),
            remedy: defect.remedy(),
        }
    }
}

impl From<&Diagnosis> for DefectList {
    fn from(diagnosis: &Diagnosis) -> Self {
        let counts =
            diagnosis.counts().into_iter().map(|(code, count)| DefectCount { code, count }).collect();
        DefectList { counts, list: diagnosis.defects.iter().map(DefectFigures::from).collect() }
    }
}

impl DefectList {
    /// The defects of a diagnosis, and a coordinate too large to compute with: areas cannot be told from 0 then, and faces without area
    /// are not listed.
    pub fn of(soup: &Soup, diagnosis: &Diagnosis) -> Self {
        let mut defects = DefectList::from(diagnosis);
        if let Some(message) = input::out_of_range(soup) {
            let (code, remedy) = ("coordinate_out_of_range", "scale the mesh, or give the vertex its place");
            defects.list.retain(|defect| defect.code != "zero_area_face");
            defects.counts.retain(|kind| kind.code != "zero_area_face");
            let (message, vertices, faces) = (message.into(), Vec::new(), Vec::new());
            defects.list.push(DefectFigures { code, message, vertices, faces, remedy });
            defects.counts.push(DefectCount { code, count: 1 });
        }
        defects
    }
}

//! The text of a page around its views: its style, its scripts, and the views' data.

use super::packed::PageView;
use crate::failure::Failure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

/// The page of views alone, which the Python package fills in the same way.
const FRAME: &str = include_str!("../gallery/view.html");
pub const STYLE: &str = include_str!("../gallery/page.css");
/// The scripts of a page, each of which uses those before it; the first is a library (MIT, its licence at its head).
const SCRIPTS: [&str; 4] = [
    include_str!("../gallery/picogl.min.js"),
    include_str!("../gallery/shape.js"),
    include_str!("../gallery/paint.js"),
    include_str!("../gallery/turn.js"),
];

/// The scripts of a page as one text.
pub static PROGRAM: std::sync::LazyLock<String> = std::sync::LazyLock::new(|| SCRIPTS.join("\n"));

/// The page of these views, each under its name.
///
/// # Errors
/// [`Failure::Failed`] for a frame without a place for one of the parts, which this build's has.
pub fn of_views(title: &str, named: &[(String, PageView)]) -> Result<String, Failure> {
    let title = escaped(title);
    let (mut body, mut views) = (format!("<h1>{title}</h1>"), Map::new());
    for (k, (name, view)) in named.iter().enumerate() {
        let key = if k == 0 { "view".into() } else { format!("view-{}", k + 1) };
        if named.len() > 1 {
            body += &format!("\n<h2>{}</h2>", escaped(name));
        }
        body += &format!("\n<canvas data-view=\"{key}\"></canvas>\n<p class=\"said\"></p>");
        views.insert(key, json!(view));
    }
    let marks = [
        ("{title}", &title[..]),
        ("{style}", STYLE),
        ("{body}", &body),
        ("{views}", &data(views)),
        ("{program}", &PROGRAM),
    ];
    fill(FRAME, &marks)
}

/// The data of views as a page holds them. No end tag can begin inside: base64 has no `<`, and what could is written as its number.
pub fn data(views: Map<String, Value>) -> String {
    Value::Object(views).to_string().replace('<', "\\u003c")
}

/// A text with each of the marks, which come in this order, replaced.
///
/// # Errors
/// [`Failure::Failed`] for a text without one of the marks.
pub fn fill(frame: &str, marks: &[(&str, &str)]) -> Result<String, Failure> {
    let (mut page, mut rest) = (String::new(), frame);
    for (mark, text) in marks {
        let (before, after) = rest
            .split_once(mark)
            .ok_or_else(|| Failure::Failed(format!("the page has no place for {mark}")))?;
        page.extend([before, text]);
        rest = after;
    }
    Ok(page + rest)
}

/// A text as it stands in a page, also in quotes.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A picture as an address that holds it.
pub fn embedded(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

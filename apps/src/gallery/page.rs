//! The gallery as one HTML page without other files: pictures, commands, figures of the reports, and views that turn.

use super::view::MOST_VERTICES;
use crate::failure::Failure;
use crate::page::{PROGRAM, PageView, STYLE, data, embedded, escaped, fill};
use serde_json::{Map, Value, json};
use std::fmt::Write;

const FRAME: &str = include_str!("page.html");

/// Longest list of a report whose entries are shown.
const LONGEST_LIST: usize = 6;

/// A picture with its description, commands, report and view.
pub struct Exhibit {
    pub name: &'static str,
    pub about: String,
    /// The commands, a line each.
    pub commands: Vec<String>,
    /// Bytes of the picture's file, or why it was left out.
    pub picture: Result<Vec<u8>, String>,
    pub report: Option<Value>,
    /// The view, or why there is none.
    pub view: Result<PageView, String>,
}

/// A section of the page.
pub struct PageSection {
    pub title: String,
    pub exhibits: Vec<Exhibit>,
    /// Names of exhibits that stand in an earlier section.
    pub earlier: Vec<&'static str>,
}

/// The page.
pub fn write(parts: &[PageSection]) -> Result<String, Failure> {
    let (mut body, mut contents, mut views) = (String::new(), String::new(), Map::new());
    for (k, PageSection { title, exhibits, earlier }) in parts.iter().enumerate() {
        let title = escaped(title);
        push(&mut contents, format_args!("<a href=\"#part-{k}\">{title}</a>\n"));
        push(&mut body, format_args!("<h2 id=\"part-{k}\">{title}</h2>\n"));
        for exhibit in exhibits {
            push(&mut body, format_args!("{}", article(exhibit)));
            if let Ok(view) = &exhibit.view {
                views.insert(exhibit.name.into(), json!(view));
            }
        }
        if !earlier.is_empty() {
            let links: Vec<_> =
                earlier.iter().map(|name| format!("<a href=\"#{name}\">{name}</a>")).collect();
            push(&mut body, format_args!("<p>See also above: {}.</p>\n", links.join(", ")));
        }
    }
    let views = data(views);
    let limit = MOST_VERTICES.to_string();
    let filled = [
        ("{style}", STYLE),
        ("{limit}", &limit),
        ("{contents}", &contents),
        ("{body}", &body),
        ("{views}", &views),
        ("{program}", &PROGRAM),
    ];
    fill(FRAME, &filled)
}

fn article(exhibit: &Exhibit) -> String {
    let Exhibit { name, about, commands, picture, report, view } = exhibit;
    let mut text = format!("<article id=\"{name}\">\n<h3>{name}: {}</h3>\n", escaped(about));
    match picture {
        Ok(png) => push(&mut text, format_args!("<img src=\"{}\" alt=\"{name}\">\n", embedded(png))),
        Err(why) => push(&mut text, format_args!("<p class=\"fails\">Left out: {}</p>\n", escaped(why))),
    }
    match view {
        Ok(_) => push(
            &mut text,
            format_args!(
                "<canvas data-view=\"{name}\" aria-label=\"{name}, to be turned\"></canvas><p class=\"said\"></p>\n"
            ),
        ),
        Err(why) => push(&mut text, format_args!("<p class=\"note\">{}</p>\n", escaped(why))),
    }
    let lines: Vec<_> = commands.iter().map(|line| format!("<code>{}</code>", escaped(line))).collect();
    push(&mut text, format_args!("<p>{}</p>\n", lines.join("<br>\n")));
    if let Some(report) = report {
        push(
            &mut text,
            format_args!("<details><summary>Numbers of its report</summary>\n{}</details>\n", tables(report)),
        );
    }
    text + "</article>\n"
}

/// The figures of a report, and its checks with what they are held against.
fn tables(report: &Value) -> String {
    let mut text = String::from("<table>\n");
    for part in ["input", "result"] {
        for (name, value) in
            report[part].as_object().into_iter().flatten().filter(|(name, _)| *name != "path")
        {
            if let Some(value) = shown(value) {
                push(&mut text, format_args!("<tr><td>{part}</td><td>{name}</td><td>{value}</td></tr>\n"));
            }
        }
    }
    for (name, check) in report["checks"].as_object().into_iter().flatten() {
        let class = if check["holds"] == json!(true) { "" } else { " class=\"fails\"" };
        let (value, limit) = (&check["value"], &check["limit"]);
        push(
            &mut text,
            format_args!("<tr{class}><td>check</td><td>{name}</td><td>{value} ≤ {limit}</td></tr>\n"),
        );
    }
    if let Some(total) = report["seconds"]["total"].as_f64() {
        push(&mut text, format_args!("<tr><td>seconds</td><td>total</td><td>{total:.3}</td></tr>\n"));
    }
    text + "</table>\n"
}

/// A number, a word, or a short list of such; nothing for what is longer or empty.
fn shown(value: &Value) -> Option<String> {
    match value {
        Value::Null | Value::Object(_) => None,
        Value::String(text) => Some(escaped(text)),
        Value::Array(list) if list.is_empty() || list.len() > LONGEST_LIST => None,
        Value::Array(list) => list.iter().map(shown).collect::<Option<Vec<_>>>().map(|list| list.join(", ")),
        value => Some(value.to_string()),
    }
}

fn push(text: &mut String, more: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = text.write_fmt(more);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exhibit(name: &'static str, picture: Result<Vec<u8>, String>) -> Exhibit {
        let report = json!({
            "input": {"path": "/secret/m.obj", "vertices": 7},
            "result": {"long": [1, 2, 3, 4, 5, 6, 7], "modulus": [0.5, 1.25], "none": null},
            "checks": {"gauss_bonnet": {"value": 1e-15, "limit": 1e-9, "holds": true}, "bad": {"value": 2, "limit": 1, "holds": false}},
        });
        let commands = vec!["ricci make a -o b && ricci flow <b>".into()];
        Exhibit {
            name,
            about: "a < b".into(),
            commands,
            picture,
            report: Some(report),
            view: Err("no view {body}".into()),
        }
    }

    #[test]
    fn everything_of_an_exhibit_is_on_the_page() {
        let exhibits = vec![exhibit("one", Ok(vec![1, 2, 3])), exhibit("two", Err("why & wherefore".into()))];
        let page =
            write(&[PageSection { title: "Title".into(), exhibits, earlier: vec!["zero"] }]).ok().unwrap();
        for text in [
            "id=\"one\"",
            "data:image/png;base64,AQID",
            "a &lt; b",
            "ricci flow &lt;b&gt;",
            "why &amp; wherefore",
            "no view {body}",
            "<td>vertices</td><td>7</td>",
            "<td>modulus</td><td>0.5, 1.25</td>",
            "1e-15 ≤ 1e-9",
            "class=\"fails\"><td>check</td><td>bad",
            "href=\"#zero\"",
            "id=\"views\">{}</script>",
        ] {
            assert!(page.contains(text), "{text} is missing");
        }
        for text in ["secret", "<td>long</td>", "<td>none</td>"] {
            assert!(!page.contains(text), "{text} is there");
        }
    }
}

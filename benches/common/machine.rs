//! A description of the machine on which a page of results was made.

use std::fmt::Write;

/// The load averages of the system over 1, 5 and 15 minutes, as it writes them.
pub fn load() -> Option<String> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    Some(text.split_whitespace().take(3).collect::<Vec<_>>().join(" "))
}

fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|l| l.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_string())
}

/// Append formatted text to a page.
pub fn put(page: &mut String, text: std::fmt::Arguments<'_>) {
    page.write_fmt(text).unwrap();
}

/// The machine and its load. `peers`: the versions of the peers, or why there are none; none if no peers were asked for.
pub fn machine(page: &mut String, peers: Option<Result<String, String>>, load: [Option<String>; 2]) {
    let cores = std::thread::available_parallelism().map_or(1, |n| n.get());
    let processor = processor().unwrap_or_else(|| "a processor without a name".into());
    put(
        page,
        format_args!(
            "\n## Machine\n\n{processor}, {cores} cores. Where no number of threads is given the flow runs on {cores}; faer runs on one.\n"
        ),
    );
    match peers {
        None => {}
        Some(Err(why)) => put(page, format_args!("No peers: {why}.\n")),
        Some(Ok(libraries)) => {
            put(page, format_args!("Peers: {libraries}. Each solver is a process of its own.\n"))
        }
    }
    if let [Some(start), Some(end)] = load {
        put(page, format_args!("Load averages (1, 5, 15 minutes) at the start {start}, at the end {end}.\n"));
    }
}

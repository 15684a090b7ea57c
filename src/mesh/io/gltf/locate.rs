//! Search for the position of a part of a JSON document, which the parser does not report, for error messages.

/// The first byte of entry `index` in the array `key` of the outermost object of a valid document.
pub(super) fn locate(json: &[u8], key: &str, index: usize) -> Option<usize> {
    let (mut at, mut depth, mut left) = (0, 0usize, index);
    // The last string of the outermost object, and true inside the array with this name.
    let (mut name, mut inside): (&[u8], bool) = (b"", false);
    while let Some(&byte) = json.get(at) {
        if inside && depth == 2 && left == 0 && !byte.is_ascii_whitespace() && byte != b',' {
            return (byte != b']').then_some(at);
        }
        match byte {
            b'"' => {
                let start = at + 1;
                at = end_of_string(json, start)?;
                name = if depth == 1 { &json[start..at] } else { name };
            }
            b'[' | b'{' => {
                depth += 1;
                inside = if depth == 2 { byte == b'[' && name == key.as_bytes() } else { inside };
            }
            b']' | b'}' => {
                depth = depth.checked_sub(1)?;
                inside &= depth > 1;
            }
            b',' if inside && depth == 2 => left -= 1,
            _ => {}
        }
        at += 1;
    }
    None
}

/// The byte of the quote that ends a string.
fn end_of_string(json: &[u8], start: usize) -> Option<usize> {
    let mut at = start;
    loop {
        match json.get(at)? {
            b'"' => return Some(at),
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
}

/// The byte at a line and column as the JSON parser counts them, both from 1.
pub(super) fn byte_of(json: &[u8], line: usize, column: usize) -> usize {
    let start: usize =
        json.split_inclusive(|&b| b == b'\n').take(line.saturating_sub(1)).map(<[u8]>::len).sum();
    (start + column.saturating_sub(1)).min(json.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_found_past_strings_and_nested_lists() {
        let json = br#" {"a":{"nodes":[9]}, "x\"nodes": [[1,2],"]"], "nodes" : [ {"m":[1,2]} ,{"nodes":[5]}, 7 ], "b":[] }"#;
        let rest = |index| locate(json, "nodes", index).map(|at| &json[at..at + 3]);
        assert_eq!(rest(0), Some(&b"{\"m"[..]));
        assert_eq!(rest(1), Some(&b"{\"n"[..]));
        assert_eq!(rest(2), Some(&b"7 ]"[..]));
        assert_eq!((rest(3), locate(json, "b", 0), locate(json, "c", 0)), (None, None, None));
    }

    #[test]
    fn columns_become_bytes() {
        let json = b"{\n  \"a\": x\n}";
        assert_eq!(json[byte_of(json, 2, 8)], b'x');
        assert_eq!(byte_of(json, 1, 1), 0);
    }
}

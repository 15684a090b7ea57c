//! Lists of elements in messages.

/// The first few elements of a list.
pub fn named<Id: ToString>(one: &str, many: &str, list: &[Id]) -> String {
    const SHOWN: usize = 5;
    let ids: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
    let more = if list.len() > SHOWN { format!(" … ({} in all)", list.len()) } else { String::new() };
    format!("{} {}{more}", if list.len() == 1 { one } else { many }, ids.join(", "))
}

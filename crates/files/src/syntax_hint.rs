//! What may have been meant by a text that is no TOML.

/// A hint to put behind the message of the parser, for an error at byte `at`; empty where there is none.
pub(crate) fn hint(text: &str, at: usize) -> String {
    let meant = |words: &str| format!("; {words}");
    let first = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
    if first.starts_with('{') {
        return meant("this looks like JSON, and an arm file is TOML: `hydrostat init` writes one");
    }
    if is_yaml(first) {
        return meant("this looks like YAML, and an arm file is TOML: `hydrostat init` writes one");
    }
    let value = line_at(text, at).split_once('=').map(|(_, value)| value.split('#').next().unwrap_or_default().trim());
    match value {
        Some(value) if is_decimal_comma(value) => {
            meant(&format!("decimals follow a point: {}", value.replace(',', ".")))
        }
        Some(value) if value.starts_with('.') && value[1..].starts_with(|c: char| c.is_ascii_digit()) => {
            meant(&format!("a number begins with a digit: 0{}", first_word(value)))
        }
        Some(value) if has_bare_unit(value) => {
            meant(&format!("a number with a unit stands in quotes: \"{}\"", short(value)))
        }
        _ => String::new(),
    }
}

/// The line around byte `at`, or the one before where it is an end of line.
fn line_at(text: &str, at: usize) -> &str {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let start = text[..at].rfind('\n').map_or(0, |k| k + 1);
    text[start..].lines().next().unwrap_or_default()
}

/// `key:`, or `key: value`.
fn is_yaml(line: &str) -> bool {
    let Some((key, value)) = line.split_once(':') else { return line == "---" };
    let is_word = !key.is_empty() && key.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-');
    is_word && (value.is_empty() || value.starts_with(' '))
}

/// `110,5`.
fn is_decimal_comma(value: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.len() < 30 && text.bytes().all(|byte| byte.is_ascii_digit());
    value.split_once(',').is_some_and(|(whole, part)| digits(whole.trim_start_matches(['+', '-'])) && digits(part))
}

/// `245 mm` without quotes.
fn has_bare_unit(value: &str) -> bool {
    let Some((number, unit)) = value.split_once(' ') else { return false };
    let unit = unit.trim();
    number.parse::<f64>().is_ok_and(f64::is_finite)
        && unit.len() < 12
        && unit.starts_with(|c: char| c.is_alphabetic() || c == '%' || c == '1')
}

fn first_word(value: &str) -> String {
    short(value.split_whitespace().next().unwrap_or_default())
}

fn short(value: &str) -> String {
    crate::error::shortened(value)
}

//! Rust sources as words and signs, just enough to tell code from what is not.

/// Words (with `::` among them) and other signs; comments, strings and lifetimes are left out.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(hashes) = raw_string(rest) {
            let end = format!("\"{}", "#".repeat(hashes));
            let start = hashes + 2;
            rest[start..]
                .find(&end)
                .map_or(rest.len(), |at| start + at + end.len())
        } else if first == '"' {
            quoted(rest)
        } else if first == '\'' {
            character(rest)
        } else {
            let word = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
            let length = match word.unwrap_or(rest.len()) {
                0 if rest.starts_with("::") => 2,
                0 => first.len_utf8(),
                word => word,
            };
            if !first.is_whitespace() {
                tokens.push(rest[..length].to_owned());
            }
            length
        };
        rest = &rest[length..];
    }
    tokens
}

/// Number of `#` where a raw string starts.
fn raw_string(text: &str) -> Option<usize> {
    let inner = text.strip_prefix('r')?.trim_start_matches('#');
    inner.starts_with('"').then(|| text.len() - 1 - inner.len())
}

/// Length of a string literal.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        if c == '"' && !escaped {
            return at + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    text.len()
}

/// Length of a character literal, or of a lifetime.
fn character(text: &str) -> usize {
    let inner: Vec<(usize, char)> = text.char_indices().skip(1).take(2).collect();
    match inner[..] {
        [(_, '\\'), (second, _)] => {
            let after = second + 1;
            text[after..]
                .find('\'')
                .map_or(text.len(), |at| after + at + 1)
        }
        [_, (end, '\'')] => end + 1,
        _ => 1,
    }
}

/// Everything but what stands under `#[cfg(test)]`, up to its semicolon or closing brace.
pub(crate) fn without_tests(tokens: &[String]) -> Vec<String> {
    let marker = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut shipped = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if !tokens[at..]
            .iter()
            .map(String::as_str)
            .take(marker.len())
            .eq(marker)
        {
            shipped.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let mut depth = 0;
        for (offset, token) in tokens[at..].iter().enumerate() {
            depth += i32::from(token == "{") - i32::from(token == "}");
            let ended = depth == 0 && (token == "}" || token == ";");
            if ended || at + offset + 1 == tokens.len() {
                at += offset + 1;
                break;
            }
        }
    }
    shipped
}

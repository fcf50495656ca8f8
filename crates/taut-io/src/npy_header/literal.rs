//! The few Python literals that an npy header is made of: dictionaries, tuples, text, booleans, counts.

/// A literal.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Literal {
    Text(String),
    Bool(bool),
    /// A tuple of counts.
    Tuple(Vec<u64>),
    /// Entries in the order of the text.
    Dict(Vec<(String, Literal)>),
    /// A list, which only element types of records have; what it holds does not matter.
    List,
}

/// Reads a dictionary as long as the text.
pub(super) fn parse(text: &str) -> Option<Literal> {
    let mut rest = text.trim();
    let found = dict(&mut rest)?;
    rest.trim().is_empty().then_some(found)
}

fn dict(rest: &mut &str) -> Option<Literal> {
    eat(rest, '{')?;
    let mut entries = Vec::new();
    while eat(rest, '}').is_none() {
        let key = quoted(rest)?;
        eat(rest, ':')?;
        entries.push((key, value(rest)?));
        if eat(rest, ',').is_none() {
            eat(rest, '}')?;
            break;
        }
    }
    Some(Literal::Dict(entries))
}

fn value(rest: &mut &str) -> Option<Literal> {
    *rest = rest.trim_start();
    match rest.chars().next()? {
        '\'' | '"' => quoted(rest).map(Literal::Text),
        '(' => tuple(rest),
        '[' => list(rest),
        _ => {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
            let word;
            (word, *rest) = rest.split_at(end);
            match word {
                "True" => Some(Literal::Bool(true)),
                "False" => Some(Literal::Bool(false)),
                _ => None,
            }
        }
    }
}

fn tuple(rest: &mut &str) -> Option<Literal> {
    eat(rest, '(')?;
    let mut counts = Vec::new();
    while eat(rest, ')').is_none() {
        *rest = rest.trim_start();
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        counts.push(rest[..end].parse().ok()?);
        // Python 2 wrote long counts with an L.
        *rest = rest[end..].trim_start_matches('L');
        if eat(rest, ',').is_none() {
            eat(rest, ')')?;
            break;
        }
    }
    Some(Literal::Tuple(counts))
}

/// Steps over a list by its brackets; without recursion, so that depth costs nothing.
fn list(rest: &mut &str) -> Option<Literal> {
    let mut depth = 0_usize;
    loop {
        *rest = rest.trim_start();
        match rest.chars().next()? {
            '\'' | '"' => {
                quoted(rest)?;
                continue;
            }
            '[' | '(' => depth += 1,
            ']' | ')' => depth -= 1,
            _ => {}
        }
        let mut chars = rest.chars();
        chars.next();
        *rest = chars.as_str();
        if depth == 0 {
            return Some(Literal::List);
        }
    }
}

fn quoted(rest: &mut &str) -> Option<String> {
    *rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
    let end = rest[1..].find(quote)?;
    let text = rest[1..1 + end].to_owned();
    *rest = &rest[end + 2..];
    Some(text)
}

fn eat(rest: &mut &str, wanted: char) -> Option<()> {
    *rest = rest.trim_start().strip_prefix(wanted)?;
    Some(())
}

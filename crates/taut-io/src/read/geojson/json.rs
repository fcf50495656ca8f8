//! JSON text as a tree of values.
//!
//! *Trap.* Lists can be nested as deep as the text is long: [`DEPTH_MAX`] keeps the recursion short. A byte or two of text can be a
//! value of tens of bytes: what values take is counted while they are read.

/// Lists and objects within each other; GeoJSON has at most ten.
const DEPTH_MAX: usize = 64;

/// Bytes counted for a value: its place in a list that grows by doubling, of which the old half is copied.
const VALUE_BYTES: u64 = 3 * size_of::<Value>() as u64;

/// Bytes counted for a list or an object besides its values: the least that is allocated for one, four places.
const LIST_BYTES: u64 = 4 * size_of::<(String, Value)>() as u64;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::read) enum Value {
    Null,
    Bool,
    Number(f64),
    Text(String),
    Array(Vec<Value>),
    /// Fields in the order of the text.
    Object(Vec<(String, Value)>),
}

/// Why a text is refused.
#[derive(Debug, PartialEq)]
pub(in crate::read) enum Refusal {
    /// It is no JSON: the line and what is wrong.
    NotJson(String),
    /// Its values take more than the memory allowed for them: the bytes counted so far.
    TooLarge(u64),
}

/// Reads one value as long as the text, of at most `memory` bytes.
pub(in crate::read) fn parse(text: &[u8], memory: u64) -> Result<Value, Refusal> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut parser = Parser { text, at: 0, held: 0, memory };
    let found = parser.value(0).and_then(|value| {
        parser.skip_blanks();
        match parser.at == text.len() {
            true => Ok(value),
            false => Err("text after the end of the document"),
        }
    });
    found.map_err(|problem| {
        if parser.held > parser.memory {
            return Refusal::TooLarge(parser.held);
        }
        let line = 1 + text[..parser.at].iter().filter(|&&byte| byte == b'\n').count();
        Refusal::NotJson(format!("line {line}: {problem}"))
    })
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    /// Bytes counted for the values so far.
    held: u64,
    /// Most of them.
    memory: u64,
}

type Parsed<T> = Result<T, &'static str>;

impl Parser<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    /// Counts bytes that are about to be allocated.
    fn hold(&mut self, bytes: u64) -> Parsed<()> {
        self.held = self.held.saturating_add(bytes);
        match self.held > self.memory {
            true => Err("the values take too much memory"),
            false => Ok(()),
        }
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(|byte| b" \t\r\n".contains(&byte)) {
            self.at += 1;
        }
    }

    /// Returns true if the next byte that is no blank is this one, which is then read.
    fn eat(&mut self, byte: u8) -> bool {
        self.skip_blanks();
        let is_next = self.peek() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    fn value(&mut self, depth: usize) -> Parsed<Value> {
        if depth > DEPTH_MAX {
            return Err("lists are nested too deep");
        }
        self.hold(VALUE_BYTES)?;
        self.skip_blanks();
        match self.peek() {
            Some(b'{') => self.object(depth),
            Some(b'[') => self.array(depth),
            Some(b'"') => self.text().map(Value::Text),
            Some(b'-' | b'0'..=b'9') => self.number(),
            Some(_) => self.word(),
            None => Err("the text ends too early"),
        }
    }

    fn object(&mut self, depth: usize) -> Parsed<Value> {
        self.at += 1;
        self.hold(LIST_BYTES)?;
        let mut fields = vec![];
        if self.eat(b'}') {
            return Ok(Value::Object(fields));
        }
        loop {
            self.skip_blanks();
            if self.peek() != Some(b'"') {
                return Err("expected the name of a field");
            }
            self.hold(3 * size_of::<String>() as u64)?;
            let name = self.text()?;
            if !self.eat(b':') {
                return Err("expected a colon");
            }
            fields.push((name, self.value(depth + 1)?));
            match (self.eat(b','), self.eat(b'}')) {
                (true, false) => {}
                (false, true) => return Ok(Value::Object(fields)),
                _ => return Err("expected a comma or the end of an object"),
            }
        }
    }

    fn array(&mut self, depth: usize) -> Parsed<Value> {
        self.at += 1;
        self.hold(LIST_BYTES)?;
        let mut items = vec![];
        if self.eat(b']') {
            return Ok(Value::Array(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            match (self.eat(b','), self.eat(b']')) {
                (true, false) => {}
                (false, true) => return Ok(Value::Array(items)),
                _ => return Err("expected a comma or the end of a list"),
            }
        }
    }

    fn number(&mut self) -> Parsed<Value> {
        let rest = &self.text[self.at..];
        let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
        let end = rest.iter().position(|byte| !is_part(byte)).unwrap_or(rest.len());
        let value = fast_float2::parse(&rest[..end]).map_err(|_| "this is no number")?;
        self.at += end;
        Ok(Value::Number(value))
    }

    fn word(&mut self) -> Parsed<Value> {
        let words: [(&[u8], Value); 3] =
            [(b"null", Value::Null), (b"true", Value::Bool), (b"false", Value::Bool)];
        let rest = &self.text[self.at..];
        let (word, value) =
            words.into_iter().find(|(word, _)| rest.starts_with(word)).ok_or("this is no value")?;
        self.at += word.len();
        Ok(value)
    }

    /// Text between quotes.
    fn text(&mut self) -> Parsed<String> {
        self.at += 1;
        let mut bytes = vec![];
        loop {
            let byte = self.peek().ok_or("a text does not end")?;
            self.at += 1;
            self.hold(3)?;
            match byte {
                b'"' => break,
                b'\\' => {
                    let escaped = self.peek().ok_or("a text does not end")?;
                    self.at += 1;
                    let character = match escaped {
                        b'b' => '\u{8}',
                        b'f' => '\u{c}',
                        b'n' => '\n',
                        b'r' => '\r',
                        b't' => '\t',
                        b'u' => self.numbered()?,
                        b'"' | b'\\' | b'/' => char::from(escaped),
                        _ => return Err("a backslash before a character that needs none"),
                    };
                    bytes.extend_from_slice(character.encode_utf8(&mut [0; 4]).as_bytes());
                }
                other => bytes.push(other),
            }
        }
        String::from_utf8(bytes).map_err(|_| "a text is not UTF-8")
    }
}

impl Parser<'_> {
    /// A character by its number, or by those of the two halves that UTF-16 has for it.
    fn numbered(&mut self) -> Parsed<char> {
        let high = self.unit()?;
        let number = match high {
            0xd800..0xdc00 => {
                let begins = self.text[self.at..].starts_with(b"\\u");
                self.at += if begins { 2 } else { 0 };
                match begins.then(|| self.unit()).transpose()? {
                    Some(low @ 0xdc00..0xe000) => {
                        0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00)
                    }
                    _ => return Err("half a character"),
                }
            }
            whole => whole,
        };
        char::from_u32(number).ok_or("half a character")
    }

    /// The four hexadecimal digits of a unit of UTF-16.
    fn unit(&mut self) -> Parsed<u32> {
        let digits = self.text.get(self.at..self.at + 4).unwrap_or_default();
        let value = |value: u32, digit: &u8| Some(16 * value + char::from(*digit).to_digit(16)?);
        let unit = digits.iter().try_fold(0, value).filter(|_| digits.len() == 4);
        self.at += digits.len();
        unit.ok_or("expected four hexadecimal digits after \\u")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read() {
        let found =
            parse(b"\xef\xbb\xbf {\"a\": [1, -2.5e3, []], \"b\\\"\": {}, \"c\": null}\n", u64::MAX)
                .unwrap();
        let numbers = vec![Value::Number(1.0), Value::Number(-2500.0), Value::Array(vec![])];
        let expected =
            [("a", Value::Array(numbers)), ("b\"", Value::Object(vec![])), ("c", Value::Null)];
        assert_eq!(found, Value::Object(expected.map(|(k, v)| (k.to_owned(), v)).to_vec()));
    }

    #[test]
    fn escapes_are_characters() {
        let found = parse(br#""\u00f4\uD83D\ude00\/\"\\\n""#, u64::MAX);
        assert_eq!(found, Ok(Value::Text("\u{f4}\u{1f600}/\"\\\n".to_owned())));
    }

    #[test]
    fn what_is_no_json_is_refused_by_line() {
        for (text, problem) in [
            ("", "line 1: the text ends too early"),
            ("[1,\n2,,3]", "line 2: this is no value"),
            ("{\"a\" 1}", "line 1: expected a colon"),
            ("[1 2]", "line 1: expected a comma or the end of a list"),
            ("[1,]", "line 1: expected a comma or the end of a list"),
            ("{} x", "line 1: text after the end of the document"),
            ("\"abc", "line 1: a text does not end"),
            ("[--1]", "line 1: this is no number"),
            ("\"\\x\"", "line 1: a backslash before a character that needs none"),
            ("\"\\u00g0\"", "line 1: expected four hexadecimal digits after \\u"),
            ("\"\\u00", "line 1: expected four hexadecimal digits after \\u"),
            ("\"\\ud83d\"", "line 1: half a character"),
            ("\"\\ude00\"", "line 1: half a character"),
        ] {
            let refusal = Refusal::NotJson(problem.to_owned());
            assert_eq!(parse(text.as_bytes(), u64::MAX), Err(refusal), "{text}");
        }
        let deep = parse("[".repeat(100_000).as_bytes(), u64::MAX);
        assert_eq!(deep, Err(Refusal::NotJson("line 1: lists are nested too deep".to_owned())));
    }

    #[test]
    fn values_that_outgrow_the_memory_are_refused() {
        // Two bytes of text are a list of some hundred bytes.
        let lists = format!("[{}[]]", "[],".repeat(1000));
        let text = format!("\"{}\"", "a".repeat(100_000));
        for text in [lists.as_str(), &text] {
            assert!(parse(text.as_bytes(), 1 << 20).is_ok());
            let refused = parse(text.as_bytes(), 50_000);
            assert!(matches!(refused, Err(Refusal::TooLarge(50_001..60_000))), "{refused:?}");
        }
    }
}

//! The tags of an XML text with their attributes.
//!
//! *Trap.* What is no tag is passed over: text, comments, instructions, CDATA, and a document type with what it declares. Entities
//! in values are left as they stand.

use std::ops::Range;

use crate::read::chains::Stop;

/// A tag.
pub(super) enum Tag<'a> {
    Start {
        /// The name without the prefix of its namespace.
        name: &'a [u8],
        attributes: Vec<Attribute<'a>>,
        /// Whether the element has no end tag.
        is_whole: bool,
    },
    End {
        /// Where it begins.
        at: usize,
    },
}

pub(super) struct Attribute<'a> {
    pub(super) name: &'a [u8],
    /// Where the value stands in the text.
    pub(super) value: Range<usize>,
}

pub(super) struct Tags<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Tags<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Tags { text, at: 0 }
    }

    /// The next tag; none at the end of the text.
    pub(super) fn next(&mut self) -> Result<Option<Tag<'a>>, Stop> {
        loop {
            let Some(begin) = memchr::memchr(b'<', &self.text[self.at..]) else { return Ok(None) };
            let begin = self.at + begin;
            self.at = begin;
            let rest = &self.text[begin..];
            if rest.starts_with(b"<!--") {
                self.skip_past(begin + 4, b"-->", "a comment does not end")?;
            } else if rest.starts_with(b"<![CDATA[") {
                self.skip_past(begin, b"]]>", "a CDATA section does not end")?;
            } else if rest.starts_with(b"<?") {
                self.skip_past(begin, b"?>", "an instruction does not end")?;
            } else if rest.starts_with(b"<!") {
                self.skip_declaration(begin)?;
            } else if rest.starts_with(b"</") {
                self.skip_past(begin, b">", "an end tag does not end")?;
                return Ok(Some(Tag::End { at: begin }));
            } else {
                self.at += 1;
                return self.start().map(Some);
            }
        }
    }

    fn skip_past(&mut self, from: usize, end: &[u8], problem: &str) -> Result<(), Stop> {
        match memchr::memmem::find(&self.text[from..], end) {
            Some(found) => {
                self.at = from + found + end.len();
                Ok(())
            }
            None => Err(Stop::Text(from, problem.to_owned())),
        }
    }

    /// A document type, whose declarations stand between brackets.
    fn skip_declaration(&mut self, begin: usize) -> Result<(), Stop> {
        let end = memchr::memchr2(b'[', b'>', &self.text[begin..]);
        let problem = "a declaration does not end";
        match end.map(|end| begin + end) {
            Some(end) if self.text[end] == b'[' => {
                self.skip_past(end, b"]", problem)?;
                self.skip_past(self.at, b">", problem)
            }
            Some(end) => {
                self.at = end + 1;
                Ok(())
            }
            None => Err(Stop::Text(begin, problem.to_owned())),
        }
    }

    fn start(&mut self) -> Result<Tag<'a>, Stop> {
        let name = local(self.name());
        if name.is_empty() {
            return self.refuse("expected the name of an element");
        }
        let mut attributes = vec![];
        loop {
            self.skip_blanks();
            match self.peek() {
                Some(b'>') => {
                    self.at += 1;
                    return Ok(Tag::Start { name, attributes, is_whole: false });
                }
                Some(b'/') if self.text.get(self.at + 1) == Some(&b'>') => {
                    self.at += 2;
                    return Ok(Tag::Start { name, attributes, is_whole: true });
                }
                None => return self.refuse("a tag does not end"),
                Some(_) => attributes.push(self.attribute()?),
            }
        }
    }

    fn attribute(&mut self) -> Result<Attribute<'a>, Stop> {
        let name = self.name();
        self.skip_blanks();
        if name.is_empty() || self.peek() != Some(b'=') {
            return self.refuse("expected the name of an attribute and an equals sign");
        }
        self.at += 1;
        self.skip_blanks();
        let Some(quote @ (b'"' | b'\'')) = self.peek() else {
            return self.refuse("expected a value between quotes");
        };
        let begin = self.at + 1;
        match memchr::memchr(quote, &self.text[begin..]) {
            Some(length) => {
                self.at = begin + length + 1;
                Ok(Attribute { name, value: begin..begin + length })
            }
            None => self.refuse("a value does not end"),
        }
    }

    fn name(&mut self) -> &'a [u8] {
        let rest = &self.text[self.at..];
        let ends = |byte: &u8| byte.is_ascii_whitespace() || b"=/><\"'".contains(byte);
        let name = &rest[..rest.iter().position(ends).unwrap_or(rest.len())];
        self.at += name.len();
        name
    }

    fn skip_blanks(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace()) {
            self.at += 1;
        }
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn refuse<T>(&self, problem: &str) -> Result<T, Stop> {
        Err(Stop::Text(self.at, problem.to_owned()))
    }
}

fn local(name: &[u8]) -> &[u8] {
    memchr::memchr(b':', name).map_or(name, |colon| &name[colon + 1..])
}

//! The dictionary of a header: three keys in any order, as Python would read them.

/// The text that is left to read.
struct Text<'a>(&'a str);

/// Type, order and shape in the text of a header; none if it says less, or more.
pub(super) fn parse(text: &str) -> Option<(String, bool, Vec<u64>)> {
    let (mut dtype, mut fortran, mut shape) = (None, None, None);
    let mut text = Text(text);
    text.eat("{")?;
    while text.eat("}").is_none() {
        let key = text.quoted()?;
        text.eat(":")?;
        // Of a key that comes twice the last value holds, as in Python.
        match key {
            "descr" => dtype = Some(text.quoted()?.to_owned()),
            "fortran_order" => fortran = Some(text.truth()?),
            "shape" => shape = Some(text.counts()?),
            _ => return None,
        }
        if text.eat(",").is_none() {
            text.eat("}")?;
            break;
        }
    }
    text.0.trim().is_empty().then_some((dtype?, fortran?, shape?))
}

impl<'a> Text<'a> {
    fn eat(&mut self, wanted: &str) -> Option<()> {
        self.0 = self.0.trim_start().strip_prefix(wanted)?;
        Some(())
    }

    /// Text between quotes of either kind; names of types and keys hold no escapes.
    fn quoted(&mut self) -> Option<&'a str> {
        let quote = if self.eat("'").is_some() { '\'' } else { self.eat("\"").map(|()| '"')? };
        let (text, rest) = self.0.split_once(quote)?;
        self.0 = rest;
        (!text.contains(['\\', '\n'])).then_some(text)
    }

    fn truth(&mut self) -> Option<bool> {
        self.eat("True").map(|()| true).or_else(|| self.eat("False").map(|()| false))
    }

    /// A tuple of counts; Python 2 wrote long ones with an L.
    fn counts(&mut self) -> Option<Vec<u64>> {
        self.eat("(")?;
        let mut counts = Vec::new();
        while self.eat(")").is_none() {
            let digits = self.0.trim_start();
            let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
            counts.push(digits[..end].parse().ok()?);
            self.0 = &digits[end..];
            let _ = self.eat("L");
            let comma = self.eat(",");
            if comma.is_none() {
                self.eat(")")?;
                // One count in brackets without a comma is a number, not a tuple.
                return (counts.len() > 1).then_some(counts);
            }
        }
        Some(counts)
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn what_python_reads() {
        let expected = Some(("<f8".to_owned(), false, vec![5, 6]));
        for text in [
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 6), }",
            "{\"descr\": \"<f8\", \"fortran_order\": False, \"shape\": (5, 6)}",
            "{'shape':(5,6,),'fortran_order':False,'descr':'<f8'}",
            " { 'shape' : ( 5 , 6 ) ,\n\t\"fortran_order\" : False , 'descr' : '<f8' , }   \n",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5L, 6L), }",
            "{'shape': (1, 2), 'descr': '<f8', 'fortran_order': False, 'shape': (5, 6)}",
        ] {
            assert_eq!(parse(text), expected, "{text}");
        }
        let shape = |text: &str| parse(text).map(|(.., shape)| shape);
        assert_eq!(shape("{'descr': 'O', 'fortran_order': True, 'shape': ()}"), Some(vec![]));
        assert_eq!(shape("{'descr': 'O', 'fortran_order': True, 'shape': (7,)}"), Some(vec![7]));
    }

    #[test]
    fn what_it_does_not_read() {
        for text in [
            "",
            "{}",
            "{'descr': '<f8', 'fortran_order': False}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5, -6)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5 6)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (, 5)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': [5, 6]}",
            "{'descr': '<f8', 'fortran_order': Falsehood, 'shape': (5, 6)}",
            "{'descr': '<f8', 'fortran_order': 0, 'shape': (5, 6)}",
            "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (5, 6)}",
            "{'descr\": '<f8', 'fortran_order': False, 'shape': (5, 6)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 6)} more",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 6), 'more': '1'}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (5, 6), , }",
            "{'descr': '<f8' 'fortran_order': False, 'shape': (5, 6)}",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}

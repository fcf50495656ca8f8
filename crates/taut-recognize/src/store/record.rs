//! Records as bytes: names, templates, failed verifications, settings, and the hashes of them for the manifest.

use zeroize::Zeroizing;

use super::StoreError;
use super::seal::Secrets;
use crate::hand::Side;
use crate::template::{Matcher, Template};

/// Bytes of a name, at most.
pub const NAME_BYTES_MAX: usize = 1000;
/// Names are padded to multiples of so many bytes, less the two of the length, so that sizes say little of them.
const NAME_STEP: usize = 64;
/// The version of the template record.
const TEMPLATE_VERSION: u8 = 1;
/// Bytes before the numbers of a template: version, side, number of scans.
const TEMPLATE_HEAD: usize = 6;

/// The encrypted records of a person.
#[derive(Clone, Debug)]
pub(super) struct Row {
    pub(super) lookup: [u8; 32],
    pub(super) name: Vec<u8>,
    pub(super) template: Vec<u8>,
    pub(super) attempts: Vec<u8>,
}

impl Row {
    /// The hash of all records of a person for the manifest.
    pub(super) fn digest(&self, secrets: &Secrets, person: i64) -> [u8; 32] {
        let mut hasher = secrets.manifest();
        hasher.update(b"person").update(&person.to_le_bytes()).update(&self.lookup);
        for record in [&self.name, &self.template, &self.attempts] {
            hasher.update(&(record.len() as u64).to_le_bytes()).update(record);
        }
        *hasher.finalize().as_bytes()
    }
}

/// The hash of the encrypted settings for the manifest.
pub(super) fn settings_digest(secrets: &Secrets, settings: &[u8]) -> [u8; 32] {
    *secrets.manifest().update(b"settings").update(settings).finalize().as_bytes()
}

/// Refuses names that are empty, too long, or have control characters.
pub(super) fn check_name(name: &str) -> Result<(), StoreError> {
    // Zero width, and marks of the direction of writing: with them two names would look alike.
    let is_hidden = |c: char| {
        c.is_control()
            || matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
    };
    let is_plain = name.trim() == name && !name.contains(is_hidden);
    match (1..=NAME_BYTES_MAX).contains(&name.len()) && is_plain {
        true => Ok(()),
        false => Err(StoreError::Name { bytes_max: NAME_BYTES_MAX }),
    }
}

/// The name with its length, padded with zeros.
pub(super) fn name_text(name: &str) -> Zeroizing<Vec<u8>> {
    // At most NAME_BYTES_MAX.
    let mut text = Zeroizing::new(Vec::with_capacity((name.len() + 2).next_multiple_of(NAME_STEP)));
    text.extend_from_slice(&(name.len() as u16).to_le_bytes());
    text.extend_from_slice(name.as_bytes());
    text.resize((name.len() + 2).next_multiple_of(NAME_STEP), 0);
    text
}

pub(super) fn read_name(text: &[u8]) -> Option<String> {
    let (length, rest) = text.split_first_chunk::<2>()?;
    let name = rest.get(..u16::from_le_bytes(*length).into())?;
    std::str::from_utf8(name).ok().map(str::to_owned)
}

/// The template and the hand that it is of.
pub(super) fn template_text(side: Side, template: &Template) -> Zeroizing<Vec<u8>> {
    let size = TEMPLATE_HEAD + 4 * template.mean().len();
    let mut text = Zeroizing::new(Vec::with_capacity(size));
    text.push(TEMPLATE_VERSION);
    text.push(match side {
        Side::Left => 0,
        Side::Right => 1,
    });
    text.extend_from_slice(&template.scans().to_le_bytes());
    template.mean().iter().for_each(|x| text.extend_from_slice(&x.to_le_bytes()));
    text
}

pub(super) fn read_template(text: &[u8]) -> Option<(Side, Template)> {
    let (head, numbers) = text.split_first_chunk::<TEMPLATE_HEAD>()?;
    let [TEMPLATE_VERSION, side, scans @ ..] = *head else { return None };
    let side = match side {
        0 => Side::Left,
        1 => Side::Right,
        _ => return None,
    };
    let (numbers, rest) = numbers.as_chunks::<4>();
    if !rest.is_empty() {
        return None;
    }
    let mean = numbers.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Some((side, Template::from_parts(mean, u32::from_le_bytes(scans)).ok()?))
}

/// Settings: how many failures lock a person, and the matcher.
pub(super) fn settings_text(failures_max: u32, matcher: &Matcher) -> Vec<u8> {
    [failures_max.to_le_bytes().as_slice(), matcher.to_json().as_bytes()].concat()
}

pub(super) fn read_settings(text: &[u8]) -> Result<(u32, Matcher), StoreError> {
    let wrong = || StoreError::damaged("its settings cannot be read");
    let (failures_max, json) = text.split_first_chunk::<4>().ok_or_else(wrong)?;
    let matcher = Matcher::from_json(std::str::from_utf8(json).map_err(|_| wrong())?)?;
    Ok((u32::from_le_bytes(*failures_max), matcher))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_are_read_as_they_were_written() {
        for name in ["A", "Ada Lovelace", "Анна", &"x".repeat(62), &"x".repeat(NAME_BYTES_MAX)]
        {
            check_name(name).unwrap();
            let text = name_text(name);
            assert_eq!((text.len() % NAME_STEP, read_name(&text).as_deref()), (0, Some(name)));
        }
        assert_eq!(name_text("A").len(), name_text(&"x".repeat(62)).len());
        for name in ["", "a\nb", "a\u{1b}[2J", &"x".repeat(NAME_BYTES_MAX + 1)] {
            assert!(matches!(check_name(name), Err(StoreError::Name { .. })));
        }
        let template = Template::from_parts(vec![1.5, -2.25, f32::MIN_POSITIVE], 4).unwrap();
        for side in [Side::Left, Side::Right] {
            let text = template_text(side, &template);
            assert_eq!(read_template(&text), Some((side, template.clone())));
            for length in [0, 1, TEMPLATE_HEAD - 1, TEMPLATE_HEAD, text.len() - 1] {
                assert_eq!(read_template(&text[..length]), None, "{length}");
            }
        }
        assert_eq!(read_name(&[5, 0, b'a']), None);
        assert_eq!(read_name(&[2, 0, 0xff, 0xff]), None);
        assert!(read_settings(&[1, 0, 0, 0, b'{']).is_err() && read_settings(&[1]).is_err());
    }
}

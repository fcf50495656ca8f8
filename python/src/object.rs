//! Turns serde's view of a value into plain objects of Python.
//!
//! | serde | Python |
//! |---|---|
//! | a struct or a map | dict |
//! | a list of numbers | array: uint32 for numbers of 32 bits without a sign, int64 for other whole ones, else float64 |
//! | a list of lists of numbers | array of two axes; a list of arrays where the rows differ in length |
//! | any other list | list |
//! | a variant without data | its name |
//!
//! No array can be written to. Which class a dict becomes is written in `taut/_record.py`, and the type and shape that an
//! empty array has.

mod list;

use std::fmt;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use serde::ser::{self, Impossible, Serialize, Serializer};

use list::{List, Number};

/// The value as plain objects.
///
/// # Errors
/// `ValueError` for a row number that int64 does not hold.
pub(crate) fn plain<'py>(
    py: Python<'py>,
    value: &(impl Serialize + ?Sized),
) -> PyResult<Bound<'py, PyAny>> {
    let said = value.serialize(Writer { py, place: Place::Alone }).map_err(|error| error.0)?;
    Ok(said.unwrap_or_else(|| py.None().into_bound(py)))
}

/// An exception on its way through serde.
#[derive(Debug)]
pub(crate) struct Raised(PyErr);

impl fmt::Display for Raised {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Raised {}

impl ser::Error for Raised {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Raised(PyValueError::new_err(message.to_string()))
    }
}

impl From<PyErr> for Raised {
    fn from(error: PyErr) -> Self {
        Raised(error)
    }
}

/// An object, or nothing where a number went to its list.
type Converted<'py> = Result<Option<Bound<'py, PyAny>>, Raised>;

/// Where a value stands.
enum Place<'a, 'py> {
    Alone,
    /// An element of a list.
    InList(&'a mut List<'py>),
    /// An element of a list within this list.
    InRow(&'a mut List<'py>),
}

struct Writer<'a, 'py> {
    py: Python<'py>,
    place: Place<'a, 'py>,
}

impl<'a, 'py> Writer<'a, 'py> {
    fn number(self, number: Number) -> Converted<'py> {
        match self.place {
            Place::Alone => Ok(Some(number.into_object(self.py)?)),
            Place::InList(list) | Place::InRow(list) => list.push(number).map(|()| None),
        }
    }

    fn word(self, word: &str) -> Converted<'py> {
        Ok(Some(PyString::new(self.py, word).into_any()))
    }

    fn list(self) -> Result<Elements<'a, 'py>, Raised> {
        let py = self.py;
        match self.place {
            Place::Alone => Ok(Elements { py, own: List::default(), outer: None }),
            Place::InList(outer) => Ok(Elements { py, own: List::default(), outer: Some(outer) }),
            Place::InRow(_) => Err(ser::Error::custom("an array has at most two axes")),
        }
    }

    fn fields(self, variant: Option<&'static str>) -> Fields<'py> {
        let (py, entries) = (self.py, PyDict::new(self.py));
        Fields { py, entries, key: None, variant }
    }
}

/// A list in the making, or a row of the list around it.
struct Elements<'a, 'py> {
    py: Python<'py>,
    own: List<'py>,
    outer: Option<&'a mut List<'py>>,
}

impl<'py> Elements<'_, 'py> {
    fn element(&mut self, value: &(impl Serialize + ?Sized)) -> Result<(), Raised> {
        let place = match &mut self.outer {
            Some(outer) => Place::InRow(outer),
            None => Place::InList(&mut self.own),
        };
        let object = value.serialize(Writer { py: self.py, place })?;
        let list = self.outer.as_deref_mut().unwrap_or(&mut self.own);
        list.objects.extend(object);
        Ok(())
    }

    fn done(self) -> Converted<'py> {
        match self.outer {
            Some(outer) => outer.end_row(),
            None => return Ok(Some(self.own.into_object(self.py)?)),
        }
        Ok(None)
    }
}

/// A dict in the making.
struct Fields<'py> {
    py: Python<'py>,
    entries: Bound<'py, PyDict>,
    /// The key of a map whose value comes next.
    key: Option<Bound<'py, PyAny>>,
    /// The variant whose data this is.
    variant: Option<&'static str>,
}

impl<'py> Fields<'py> {
    fn done(self) -> Converted<'py> {
        let Some(variant) = self.variant else { return Ok(Some(self.entries.into_any())) };
        let outer = PyDict::new(self.py);
        outer.set_item(variant, self.entries)?;
        Ok(Some(outer.into_any()))
    }
}

/// Methods of one line for numbers of each type.
macro_rules! numbers {
    ($($method:ident: $type:ty as $number:ident,)*) => {
        $(fn $method(self, value: $type) -> Converted<'py> {
            self.number(Number::$number(value.into()))
        })*
    };
}

impl<'a, 'py> Serializer for Writer<'a, 'py> {
    type Ok = Option<Bound<'py, PyAny>>;
    type Error = Raised;
    type SerializeSeq = Elements<'a, 'py>;
    type SerializeTuple = Elements<'a, 'py>;
    type SerializeTupleStruct = Elements<'a, 'py>;
    type SerializeTupleVariant = Impossible<Self::Ok, Raised>;
    type SerializeMap = Fields<'py>;
    type SerializeStruct = Fields<'py>;
    type SerializeStructVariant = Fields<'py>;

    numbers! {
        serialize_i8: i8 as Signed,
        serialize_i16: i16 as Signed,
        serialize_i32: i32 as Signed,
        serialize_i64: i64 as Signed,
        serialize_u8: u8 as Whole,
        serialize_u16: u16 as Whole,
        serialize_u32: u32 as Short,
        serialize_u64: u64 as Whole,
        serialize_f32: f32 as Float,
        serialize_f64: f64 as Float,
    }

    fn serialize_bool(self, value: bool) -> Converted<'py> {
        Ok(Some(value.into_pyobject(self.py).map_err(PyErr::from)?.to_owned().into_any()))
    }

    fn serialize_char(self, value: char) -> Converted<'py> {
        self.word(value.encode_utf8(&mut [0; 4]))
    }

    fn serialize_str(self, value: &str) -> Converted<'py> {
        self.word(value)
    }

    fn serialize_bytes(self, value: &[u8]) -> Converted<'py> {
        value.serialize(self)
    }

    fn serialize_none(self) -> Converted<'py> {
        Ok(Some(self.py.None().into_bound(self.py)))
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Converted<'py> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Converted<'py> {
        self.serialize_none()
    }

    fn serialize_unit_struct(self, _: &'static str) -> Converted<'py> {
        self.serialize_none()
    }

    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
    ) -> Converted<'py> {
        self.word(variant)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Converted<'py> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Converted<'py> {
        let entries = PyDict::new(self.py);
        entries.set_item(variant, plain(self.py, value)?)?;
        Ok(Some(entries.into_any()))
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Elements<'a, 'py>, Raised> {
        self.list()
    }

    fn serialize_tuple(self, _: usize) -> Result<Elements<'a, 'py>, Raised> {
        self.list()
    }

    fn serialize_tuple_struct(
        self,
        _: &'static str,
        _: usize,
    ) -> Result<Elements<'a, 'py>, Raised> {
        self.list()
    }

    fn serialize_tuple_variant(
        self,
        name: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Raised> {
        Err(ser::Error::custom(format!("{name}::{variant} has no names for its parts")))
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Fields<'py>, Raised> {
        Ok(self.fields(None))
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Fields<'py>, Raised> {
        Ok(self.fields(None))
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Fields<'py>, Raised> {
        Ok(self.fields(Some(variant)))
    }
}

/// The three ways in which serde writes lists.
macro_rules! elements {
    ($($kind:ident by $method:ident,)*) => {
        $(impl<'py> ser::$kind for Elements<'_, 'py> {
            type Ok = Option<Bound<'py, PyAny>>;
            type Error = Raised;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Raised> {
                self.element(value)
            }

            fn end(self) -> Converted<'py> {
                self.done()
            }
        })*
    };
}

elements! {
    SerializeSeq by serialize_element,
    SerializeTuple by serialize_element,
    SerializeTupleStruct by serialize_field,
}

/// The two ways in which serde writes fields.
macro_rules! fields {
    ($($kind:ident,)*) => {
        $(impl<'py> ser::$kind for Fields<'py> {
            type Ok = Option<Bound<'py, PyAny>>;
            type Error = Raised;

            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                name: &'static str,
                value: &T,
            ) -> Result<(), Raised> {
                Ok(self.entries.set_item(name, plain(self.py, value)?)?)
            }

            fn end(self) -> Converted<'py> {
                self.done()
            }
        })*
    };
}

fields! { SerializeStruct, SerializeStructVariant, }

impl<'py> ser::SerializeMap for Fields<'py> {
    type Ok = Option<Bound<'py, PyAny>>;
    type Error = Raised;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Raised> {
        self.key = Some(plain(self.py, key)?);
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Raised> {
        Ok(self.entries.set_item(self.key.take(), plain(self.py, value)?)?)
    }

    fn end(self) -> Converted<'py> {
        self.done()
    }
}

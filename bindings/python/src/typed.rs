//! Python values as the types of files. An error names the key, and says what to give in place of what.

use crate::errors::input;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyMapping, PyString, PyTuple};
use serde::de::value::StringDeserializer;
use serde::de::{
    self, DeserializeOwned, DeserializeSeed, Expected, IntoDeserializer, Unexpected, Visitor,
};
use std::fmt;

/// A value of a table, as numbers, texts, lists and dicts. Numbers and arrays of NumPy become Python's.
pub(crate) fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if value.hasattr("tolist")? {
        return value.call_method0("tolist");
    }
    Ok(value.clone())
}

/// What a value with this name says. A name in front of a table's keys ends with a point.
pub(crate) fn typed<T: DeserializeOwned>(name: &str, value: &Bound<'_, PyAny>) -> PyResult<T> {
    let read = Value::of(value).and_then(T::deserialize);
    read.map_err(|wrong| input(wrong.below(name)))
}

/// A value that makes no sense.
#[derive(Debug)]
pub(crate) struct Wrong {
    /// The keys that lead to it.
    path: String,
    why: String,
    /// Whether the value is still to be shown.
    unshown: bool,
}

/// Greatest number of letters of a value in a message.
const SHOWN: usize = 60;

impl Wrong {
    fn below(self, key: &str) -> Self {
        let path = match (self.path.as_str(), key) {
            ("", _) => key.to_owned(),
            (path, "") => path.to_owned(),
            (path, key) => format!("{key}.{path}"),
        };
        Self { path, ..self }
    }

    fn shown(self, value: &Bound<'_, PyAny>) -> Self {
        if !self.unshown {
            return self;
        }
        let text = value
            .repr()
            .map_or_else(|_| "this".to_owned(), |it| it.to_string());
        let mut short: String = text.chars().take(SHOWN).collect();
        if short.len() < text.len() {
            short.push_str("..");
        }
        let why = format!("{}, not {short}", self.why);
        Self {
            why,
            unshown: false,
            ..self
        }
    }

    fn wanted(expected: &dyn Expected) -> Self {
        let expected = expected.to_string();
        let wanted = match expected.as_str() {
            "u64" | "usize" => "a whole number from 0 to 2**64 - 1",
            "u32" => "a whole number from 0 to 2**32 - 1",
            "u16" => "a whole number from 0 to 2**16 - 1",
            "u8" => "a whole number from 0 to 2**8 - 1",
            "f64" | "f32" => "a number",
            "a boolean" => "True or False",
            "a string" => "a text",
            "a sequence" => "a list",
            table if table.starts_with("struct ") => "a dict of its keys",
            pair if pair.ends_with("of size 2") || pair.ends_with("of length 2") => "a list of 2",
            triple if triple.ends_with("of size 3") || triple.ends_with("of length 3") => {
                "a list of 3"
            }
            name if name.starts_with("enum ") || name == "variant identifier" => "a name",
            other => other,
        };
        Self {
            path: String::new(),
            why: format!("give {wanted}"),
            unshown: true,
        }
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.path.is_empty() {
            return f.write_str(&self.why);
        }
        write!(f, "{}: {}", self.path, self.why)
    }
}

impl std::error::Error for Wrong {}

impl From<PyErr> for Wrong {
    fn from(error: PyErr) -> Self {
        de::Error::custom(error)
    }
}

impl de::Error for Wrong {
    fn custom<T: fmt::Display>(why: T) -> Self {
        Self {
            path: String::new(),
            why: why.to_string(),
            unshown: false,
        }
    }

    fn invalid_type(_: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::wanted(expected)
    }

    fn invalid_value(_: Unexpected<'_>, expected: &dyn Expected) -> Self {
        Self::wanted(expected)
    }

    fn invalid_length(_: usize, expected: &dyn Expected) -> Self {
        Self::wanted(expected)
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        de::Error::custom(unlike(&format!("key `{key}`"), key, known))
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Self {
        de::Error::custom(unlike(&format!("`{name}`"), name, known))
    }
}

/// What to say of a name that nobody knows.
pub(crate) fn unlike(told: &str, name: &str, known: &[&str]) -> String {
    let close = Python::attach(|py| {
        let texts = py.import("difflib")?;
        let close = texts.call_method1("get_close_matches", (name, known.to_vec(), 1))?;
        close.extract::<Vec<String>>()
    });
    let close = close.unwrap_or_default();
    let guess: String = (close.iter().map(|it| format!(" (did you mean `{it}`?)"))).collect();
    format!("there is no {told}{guess}: give {}", known.join(", "))
}

/// A value, without NumPy's types.
struct Value<'py>(Bound<'py, PyAny>);

impl<'py> Value<'py> {
    fn of(value: &Bound<'py, PyAny>) -> Result<Self, Wrong> {
        Ok(Self(plain(value)?))
    }

    fn visit<'de, V: Visitor<'de>>(&self, visitor: V) -> Result<V::Value, Wrong> {
        let value = &self.0;
        if value.is_none() {
            return visitor.visit_unit();
        }
        if value.is_instance_of::<PyBool>() {
            return visitor.visit_bool(value.extract()?);
        }
        if value.is_instance_of::<PyInt>() {
            return match (value.extract::<u64>(), value.extract::<i64>()) {
                (Ok(whole), _) => visitor.visit_u64(whole),
                (_, Ok(whole)) => visitor.visit_i64(whole),
                _ => Err(Wrong::wanted(&visitor)),
            };
        }
        if value.is_instance_of::<PyFloat>() {
            return visitor.visit_f64(value.extract()?);
        }
        if value.is_instance_of::<PyString>() {
            return visitor.visit_string(value.extract()?);
        }
        if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            let items = value.try_iter()?.collect::<PyResult<Vec<_>>>()?;
            let mut items = Items(items.into_iter().enumerate());
            let fewer = Wrong::wanted(&visitor);
            let read = visitor.visit_seq(&mut items)?;
            // What takes a pair would leave the rest.
            return items.0.next().map_or(Ok(read), |_| Err(fewer));
        }
        if let Ok(table) = value.cast::<PyMapping>() {
            let items = entries(table)?.into_iter();
            return visitor.visit_map(Entries { items, open: None });
        }
        Err(Wrong::wanted(&visitor))
    }
}

/// A key and its value.
type Entry<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>);

fn entries<'py>(table: &Bound<'py, PyMapping>) -> PyResult<Vec<Entry<'py>>> {
    table.items()?.iter().map(|item| item.extract()).collect()
}

impl<'de> de::Deserializer<'de> for Value<'_> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.visit(visitor).map_err(|wrong| wrong.shown(&self.0))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        if self.0.is_none() {
            return visitor.visit_none();
        }
        visitor.visit_some(self)
    }

    /// A key that is None is as one that is not given, if there is such a key. A list has no keys.
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let all = match self.0.cast::<PyMapping>() {
            Ok(table) => entries(table)?,
            Err(_) if self.0.is_none() => Vec::new(),
            Err(_) => return Err(Wrong::wanted(&visitor).shown(&self.0)),
        };
        let absent = |(key, value): &Entry<'_>| {
            value.is_none() && (key.extract::<String>()).is_ok_and(|it| keys.contains(&&*it))
        };
        let items = all.into_iter().filter(|entry| !absent(entry));
        visitor.visit_map(Entries { items, open: None })
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match self.0.extract::<String>() {
            Ok(name) => visitor.visit_enum(name.into_deserializer()),
            Err(_) => Err(Wrong::wanted(&visitor).shown(&self.0)),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

/// The items of a list.
struct Items<I>(I);

impl<'de, 'py, I: Iterator<Item = (usize, Bound<'py, PyAny>)>> de::SeqAccess<'de> for Items<I> {
    type Error = Wrong;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Wrong> {
        let Some((index, item)) = self.0.next() else {
            return Ok(None);
        };
        let read = Value::of(&item).and_then(|item| seed.deserialize(item));
        read.map(Some)
            .map_err(|wrong| wrong.below(&index.to_string()))
    }
}

/// The keys of a table with their values.
struct Entries<'py, I> {
    items: I,
    /// The key whose value comes next.
    open: Option<(String, Bound<'py, PyAny>)>,
}

impl<'de, 'py, I> de::MapAccess<'de> for Entries<'py, I>
where
    I: Iterator<Item = (Bound<'py, PyAny>, Bound<'py, PyAny>)>,
{
    type Error = Wrong;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Wrong> {
        let Some((key, value)) = self.items.next() else {
            return Ok(None);
        };
        let Ok(name) = key.extract::<String>() else {
            return Err(Wrong::wanted(&"texts for keys").shown(&key));
        };
        let read: StringDeserializer<Wrong> = name.clone().into_deserializer();
        self.open = Some((name, value));
        seed.deserialize(read).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Wrong> {
        let Some((name, value)) = self.open.take() else {
            return Err(de::Error::custom("a key comes before its value"));
        };
        let read = Value::of(&value).and_then(|value| seed.deserialize(value));
        read.map_err(|wrong| wrong.below(&name))
    }
}

//! The results of a parallel loop as a list.

use std::sync::{Mutex, PoisonError};

use super::{Parallel, Source, lock, run_tasks, try_run_tasks};

/// Collections of items.
pub trait Collect<Item>: Sized {
    /// All items of a source.
    fn of<S: Source<Item = Item>>(items: Parallel<S>) -> Self;
}

impl<T: Send> Collect<T> for Vec<T> {
    fn of<S: Source<Item = T>>(items: Parallel<S>) -> Self {
        let tasks = items.tasks();
        let of = |task| items.source.items(tasks.of(task)).collect();
        if tasks.len() <= 1 {
            return of(0);
        }
        let parts: Vec<Mutex<Self>> = (0..tasks.len()).map(|_| Mutex::default()).collect();
        run_tasks(parts.len(), &|task| *lock(&parts[task]) = of(task));
        let parts = parts.into_iter();
        let parts: Vec<Self> =
            parts.map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        joined(parts)
    }
}

impl<T: Send, E: Send> Collect<Result<T, E>> for Result<Vec<T>, E> {
    fn of<S: Source<Item = Result<T, E>>>(items: Parallel<S>) -> Self {
        let tasks = items.tasks();
        let of = |task| items.source.items(tasks.of(task)).collect();
        if tasks.len() <= 1 {
            return of(0);
        }
        let parts: Vec<Mutex<Self>> = (0..tasks.len()).map(|_| Mutex::new(Ok(vec![]))).collect();
        try_run_tasks(parts.len(), &|task| {
            let part: Self = of(task);
            let is_done = part.is_ok();
            *lock(&parts[task]) = part;
            is_done
        });
        let parts = parts.into_iter();
        let parts: Result<Vec<Vec<T>>, E> =
            parts.map(|part| part.into_inner().unwrap_or_else(PoisonError::into_inner)).collect();
        parts.map(joined)
    }
}

/// The items of all parts; the memory of each is given back when its items have moved.
fn joined<T>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    for mut part in parts {
        all.append(&mut part);
    }
    all
}

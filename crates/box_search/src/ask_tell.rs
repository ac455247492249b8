//! Solvers that ask for one point at a time, answered all together: points of many solvers then
//! share vector lanes and threads. What a solver is told does not depend on the others.

use std::sync::mpsc::{Receiver, Sender, channel};

use crate::evaluated::Evaluated;

/// Message of a solver.
enum Message {
    Ask(usize, Vec<f64>),
    Done,
}

/// Channel that a solver asks through.
pub(crate) struct Asker {
    who: usize,
    /// Answers from an earlier session, used up first.
    known: Evaluated,
    used: usize,
    question: Sender<Message>,
    answer: Receiver<Option<Evaluated>>,
}

impl Asker {
    /// Value of a point, and whether it had to be computed; `None`: stop.
    pub fn ask(&mut self, point: Vec<f64>) -> Option<Evaluated> {
        if self.used < self.known.len() {
            self.used += 1;
            return Some(self.known.single(self.used - 1));
        }
        self.question.send(Message::Ask(self.who, point)).ok()?;
        self.answer.recv().ok().flatten()
    }
}

impl Drop for Asker {
    fn drop(&mut self) {
        // Whoever answers may have ended already.
        self.question.send(Message::Done).ok();
    }
}

/// Runs solvers, each with its earlier answers, and answers whenever all that still run have
/// asked: `answer` gets points with their solvers, in the order of the solvers, and gives a value
/// for each, or `None` to stop them.
///
/// A solver that panics has no result.
pub(crate) fn answer_together<T: Send>(
    known: Vec<Evaluated>,
    solver: &(impl Fn(usize, &mut Asker) -> T + Sync),
    mut answer: impl FnMut(&[(usize, Vec<f64>)]) -> Option<Vec<Evaluated>>,
) -> Vec<Option<T>> {
    let (question, questions) = channel();
    std::thread::scope(|scope| {
        let mut answers = Vec::with_capacity(known.len());
        let mut threads = Vec::with_capacity(known.len());
        for (who, known) in known.into_iter().enumerate() {
            let (sender, receiver) = channel();
            answers.push(sender);
            let mut asker = Asker {
                who,
                known,
                used: 0,
                question: question.clone(),
                answer: receiver,
            };
            threads.push(scope.spawn(move || solver(who, &mut asker)));
        }
        drop(question);
        let mut running = threads.len();
        let mut asked: Vec<(usize, Vec<f64>)> = Vec::with_capacity(running);
        let mut stopped = false;
        while running > 0 {
            match questions.recv() {
                Ok(Message::Ask(who, point)) => {
                    // In the order of the solvers, whoever asked first.
                    let place = asked.partition_point(|(known, _)| *known < who);
                    asked.insert(place, (who, point));
                }
                Ok(Message::Done) => running -= 1,
                Err(_) => break,
            }
            if asked.is_empty() || asked.len() < running {
                continue;
            }
            let values = if stopped { None } else { answer(&asked) };
            stopped = values.is_none();
            let mut values = values.unwrap_or_default().into_iter();
            for (who, _) in asked.drain(..) {
                // A solver that has gone does not wait for it.
                answers[who].send(values.next()).ok();
            }
        }
        let results = threads.into_iter().map(|thread| thread.join().ok());
        results.collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(asked: &[(usize, Vec<f64>)]) -> Vec<Evaluated> {
        let value = |(_, point): &(usize, Vec<f64>)| Evaluated {
            values: vec![point[0] * 10.0],
            margins: vec![],
            failed: vec![false],
        };
        asked.iter().map(value).collect()
    }

    #[test]
    fn solvers_are_answered_together_and_leave_one_by_one() {
        let solver = |who: usize, asker: &mut Asker| -> f64 {
            (0..=who)
                .filter_map(|step| asker.ask(vec![step as f64]))
                .map(|answer| answer.values[0])
                .sum()
        };
        let mut sizes = Vec::new();
        let results = answer_together(vec![Evaluated::default(); 3], &solver, |asked| {
            sizes.push(asked.len());
            assert!(asked.is_sorted_by_key(|(who, _)| *who));
            Some(values(asked))
        });
        assert_eq!(results, [Some(0.0), Some(10.0), Some(30.0)]);
        assert_eq!(sizes, [3, 2, 1]);
    }

    #[test]
    fn a_panic_of_a_solver_does_not_keep_the_others() {
        let solver = |who: usize, asker: &mut Asker| {
            asker.ask(vec![1.0]);
            assert!(who != 1, "wanted here");
            asker.ask(vec![2.0]).map(|answer| answer.values[0])
        };
        let known = vec![Evaluated::default(); 3];
        let results = answer_together(known, &solver, |asked| Some(values(asked)));
        assert_eq!(results, [Some(Some(20.0)), None, Some(Some(20.0))]);
    }

    #[test]
    fn nobody_is_answered_after_a_stop() {
        let solver =
            |_: usize, asker: &mut Asker| (0..5).filter(|_| asker.ask(vec![1.0]).is_some()).count();
        let mut answers = 0;
        let results = answer_together(vec![Evaluated::default(); 2], &solver, |asked| {
            answers += 1;
            (answers < 3).then(|| values(asked))
        });
        assert_eq!((results, answers), (vec![Some(2); 2], 3));
    }
}

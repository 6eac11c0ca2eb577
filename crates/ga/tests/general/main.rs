//! Functions of multivectors in every signature, against the table and closed forms.

mod closed_forms;
mod functions;
mod rounding;
mod space;
mod subspaces;

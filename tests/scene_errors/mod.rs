//! Every bad input meets its exact message.

mod corpus;
mod hostile;
mod mutations;

#pragma once

// Tested by tests/contract/law_contract_test.cpp.

/// Stands at the end of a law's source: the numbers that the law computes in. The contract tests compile the laws a second
/// time, for dual numbers (tests/contract/dual/dual_laws.hpp).
#ifndef WEFT_INSTANTIATE_LAW
// A template's name stands here, which parentheses would make an expression. NOLINTBEGIN(bugprone-macro-parentheses)
#define WEFT_INSTANTIATE_LAW(Law) \
  template class Law<float>;      \
  template class Law<double>
// NOLINTEND(bugprone-macro-parentheses)
#endif

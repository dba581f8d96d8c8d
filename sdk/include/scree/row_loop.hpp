#pragma once
/// From an author's function for one ball to a vectorised loop over rows. Plug-in authors do not use this header.
#include <scree/abi.h>
#include <scree/columns.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace scree {

/// One row's value of one column. A parameter of the author's function binds to it; when it goes out of scope at the
/// end of the call, a written column is stored back. (A tuple of arguments would stop g++ from vectorising.)
template <class Parameter>
class RowCell {
 public:
  using Column = std::remove_cvref_t<Parameter>;
  static constexpr bool writes =
      std::is_lvalue_reference_v<Parameter> && !std::is_const_v<std::remove_reference_t<Parameter>>;

  SCREE_INLINE RowCell(double* const* word, std::size_t row) : word_(word), row_(row) {
    double w[Column::words];
    for (std::size_t k = 0; k < Column::words; ++k) w[k] = word[k][row];
    std::memcpy(static_cast<void*>(&value_), w, sizeof w);
  }
  SCREE_INLINE ~RowCell() {
    if constexpr (writes) {
      double w[Column::words];
      std::memcpy(w, &value_, sizeof w);
      for (std::size_t k = 0; k < Column::words; ++k) word_[k][row_] = w[k];
    }
  }
  RowCell(const RowCell&) = delete;
  RowCell& operator=(const RowCell&) = delete;

  SCREE_INLINE operator Column&() { return value_; }

 private:
  double* const* word_;
  std::size_t row_;
  Column value_;
};

/// What a member function `void (T::*)(A...) const` says about the columns it needs.
template <class Function>
struct RowFunction;
template <class T, class... A>
struct RowFunction<void (T::*)(A...) const> {
  static constexpr uint32_t words = (0u + ... + std::remove_cvref_t<A>::words);
  static constexpr std::size_t needs = sizeof...(A);

  /// Offset of the word of parameter k among the words of all parameters.
  static constexpr std::size_t offset(std::size_t k) {
    constexpr std::size_t sizes[] = {std::remove_cvref_t<A>::words...};
    std::size_t sum = 0;
    for (std::size_t j = 0; j < k; ++j) sum += sizes[j];
    return sum;
  }
  static constexpr std::array<scree_need, needs> list(uint32_t extra) {
    return {scree_need{std::remove_cvref_t<A>::column,
                       (RowCell<A>::writes ? uint32_t{SCREE_READ | SCREE_WRITE} : uint32_t{SCREE_READ}) | extra}...};
  }
  static constexpr bool writes(uint32_t column) {
    return (false || ... || (RowCell<A>::writes && std::remove_cvref_t<A>::column == column));
  }

  template <class Call, std::size_t... K>
  SCREE_INLINE static void loop(const T& process, double* const* source, std::size_t n, Call call,
                                std::index_sequence<K...>) {
    double* word[words];
    for (std::size_t k = 0; k < words; ++k) word[k] = source[k];
    // A plain struct goes into registers; anything with strings or vectors stays where it is.
    std::conditional_t<std::is_trivially_copyable_v<T>, const T, const T&> rule = process;
    const auto one = [&](std::size_t i) __attribute__((always_inline)) {
      call(rule, RowCell<A>(word + offset(K), i)...);
    };
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) one(i);
  }
  template <class Call>
  SCREE_INLINE static void loop(const T& process, double* const* source, std::size_t n, Call call) {
    loop(process, source, n, call, std::make_index_sequence<needs>());
  }
};

}  // namespace scree

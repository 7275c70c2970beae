// Switches between a source as it is and its mutants: scripts/mutants writes them into a copy of the sources, where every
// sampled mutant of a module is compiled at once and the environment says which one is alive. Nothing here changes what an
// expression means as long as its own mutant is not the one alive; a switch whose types have no such mutant (a sum of
// strings, a difference of iterators) enters itself in the list of void ones.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <type_traits>

#include <unistd.h>

namespace tautline_mutants {

inline constexpr int most = 8192;
inline unsigned char seen[most];     ///< mutants that were reached
inline unsigned char invalid[most];  ///< mutants that their types do not have

/// Writes what was reached, one line a mutant, into the directory that the environment names.
inline void write_seen() {
  const char* directory = std::getenv("TAUTLINE_MUTANTS_SEEN");
  if (!directory) return;
  std::FILE* file = std::fopen((std::string(directory) + "/" + std::to_string(::getpid())).c_str(), "w");
  if (!file) return;
  for (int id = 0; id < most; ++id) {
    if (seen[id]) std::fprintf(file, "seen %d\n", id);
    if (invalid[id]) std::fprintf(file, "void %d\n", id);
  }
  std::fclose(file);
}

inline int read_alive() {
  std::atexit(write_seen);
  const char* id = std::getenv("TAUTLINE_MUTANT");
  return id ? std::atoi(id) : -1;
}

inline const int alive = read_alive();

template <int id>
bool on() {
  seen[id] = 1;
  return alive == id;
}

template <int id>
struct Void {
  static inline const bool entered = (invalid[id] = 1, true);
};

template <int id>
void enter_void() {
  [[maybe_unused]] const volatile bool* entered = &Void<id>::entered;
}

template <class T>
inline constexpr bool number = std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && !std::is_same_v<T, char>;

/// Eigen's matrices, dense and sparse: what has a scalar and can be multiplied by it.
template <class T>
concept Matrix = requires(const T& x) {
  typename T::Scalar;
  x.rows();
  x.cols();
  x * typename T::Scalar(1);
};

template <int id, class T>
T constant(T value, std::type_identity_t<T> mutated) {
  return on<id>() ? mutated : value;
}

template <int id, class A, class B>
auto swapped(const A& a, const B& b) {
  if constexpr (std::is_integral_v<A> && std::is_integral_v<B>) {
    using Common = std::common_type_t<A, B>;
    return on<id>() ? static_cast<Common>(b) : static_cast<Common>(a);
  } else {
    enter_void<id>();
    return a;
  }
}

/// a + Sign() * b: b with the other sign. Minus() * b: in place of -b.
template <int id>
struct Sign {};
template <int id>
struct Minus {};

template <int id, class T>
auto signed_value(bool negative, const T& x) {
  if constexpr (number<T>) {
    const bool minus = on<id>() != negative;
    return minus ? static_cast<T>(-x) : x;
  } else if constexpr (Matrix<T>) {
    const bool minus = on<id>() != negative;
    return (minus ? -1.0 : 1.0) * x;
  } else {
    enter_void<id>();
    if constexpr (requires { -x; })
      return negative ? -x : x;
    else
      return x;
  }
}

template <int id, class T>
auto operator*(Sign<id>, const T& x) {
  return signed_value<id>(false, x);
}

template <int id, class T>
auto operator*(Minus<id>, const T& x) {
  return signed_value<id>(true, x);
}
template <class A, int id>
auto operator*(const A& a, Minus<id>) {
  return signed_value<id>(true, a);
}

/// a * Times() * b and a / Over() / b: the other one of the two operators.
template <int id>
struct Times {};
template <int id>
struct Over {};

template <int id, class A>
struct TimesRight {
  const A& a;
};
template <int id, class A>
struct OverRight {
  const A& a;
};

template <class A, int id>
TimesRight<id, A> operator*(const A& a, Times<id>) {
  return {a};
}
template <class A, int id>
OverRight<id, A> operator/(const A& a, Over<id>) {
  return {a};
}

template <int id, class A, class B>
auto operator*(TimesRight<id, A> left, const B& b) {
  if constexpr (number<A> && number<B>) {
    using Common = decltype(left.a * b);
    return on<id>() ? static_cast<Common>(left.a / b) : static_cast<Common>(left.a * b);
  } else if constexpr (Matrix<A> && number<B>) {
    const double factor = on<id>() ? 1.0 / static_cast<double>(b) : static_cast<double>(b);
    return left.a * factor;
  } else if constexpr (number<A> && Matrix<B>) {
    const double factor = on<id>() ? 1.0 / static_cast<double>(left.a) : static_cast<double>(left.a);
    return factor * b;
  } else {
    enter_void<id>();
    return left.a * b;
  }
}

template <int id, class A, class B>
auto operator/(OverRight<id, A> left, const B& b) {
  if constexpr (number<A> && number<B>) {
    using Common = decltype(left.a / b);
    return on<id>() ? static_cast<Common>(left.a * b) : static_cast<Common>(left.a / b);
  } else if constexpr (Matrix<A> && number<B>) {
    const double divisor = on<id>() ? 1.0 / static_cast<double>(b) : static_cast<double>(b);
    return left.a / divisor;
  } else {
    enter_void<id>();
    return left.a / b;
  }
}

/// a *= reciprocal(b).
template <int id, class T>
auto reciprocal(const T& x) {
  if constexpr (std::is_floating_point_v<T>) {
    return on<id>() ? 1 / x : x;
  } else {
    enter_void<id>();
    return x;
  }
}

/// a < Less() < b. Of whole numbers the boundary is moved (< becomes <=), of real ones, where a single point of the boundary
/// is next to nothing, the comparison is reversed (< becomes >=).
template <class A, class B>
inline constexpr bool real = std::is_floating_point_v<A> || std::is_floating_point_v<B>;

#define TAUTLINE_MUTANTS_COMPARE(Name, op, whole, reversed)                  \
  template <int id>                                                          \
  struct Name {};                                                            \
  template <int id, class A>                                                 \
  struct Name##Right {                                                       \
    const A& a;                                                              \
    template <class B>                                                       \
    bool operator op(const B& b) const {                                     \
      if (!on<id>()) return a op b;                                          \
      if constexpr (real<A, B>)                                              \
        return a reversed b;                                                 \
      else                                                                   \
        return a whole b;                                                    \
    }                                                                        \
  };                                                                         \
  template <class A, int id>                                                 \
  Name##Right<id, A> operator op(const A& a, Name<id>) {                     \
    return {a};                                                              \
  }

TAUTLINE_MUTANTS_COMPARE(Less, <, <=, >=)
TAUTLINE_MUTANTS_COMPARE(LessEqual, <=, <, >)
TAUTLINE_MUTANTS_COMPARE(Greater, >, >=, <=)
TAUTLINE_MUTANTS_COMPARE(GreaterEqual, >=, >, <)
TAUTLINE_MUTANTS_COMPARE(Equal, ==, !=, !=)
TAUTLINE_MUTANTS_COMPARE(Unequal, !=, ==, ==)
#undef TAUTLINE_MUTANTS_COMPARE

/// `and` and `or` with operands that are computed only when needed, in both forms.
template <int id, class A, class B>
bool both(const A& a, const B& b) {
  return on<id>() ? a() || b() : a() && b();
}
template <int id, class A, class B>
bool either(const A& a, const B& b) {
  return on<id>() ? a() && b() : a() || b();
}

template <int id>
struct Not {};
template <int id, class T>
bool operator*(Not<id>, const T& x) {
  return on<id>() ? static_cast<bool>(x) : !static_cast<bool>(x);
}

template <int id, class T>
T max(const T& a, const T& b) {
  return on<id>() ? std::min(a, b) : std::max(a, b);
}
template <int id, class T>
T max(std::initializer_list<T> list) {
  return on<id>() ? std::min(list) : std::max(list);
}
template <int id, class T>
T min(const T& a, const T& b) {
  return on<id>() ? std::max(a, b) : std::min(a, b);
}
template <int id, class T>
T min(std::initializer_list<T> list) {
  return on<id>() ? std::max(list) : std::min(list);
}
template <int id, class T>
auto sin(T x) {
  return on<id>() ? std::cos(x) : std::sin(x);
}
template <int id, class T>
auto cos(T x) {
  return on<id>() ? std::sin(x) : std::cos(x);
}
template <int id, class T>
auto abs(T x) {
  return on<id>() ? x : std::abs(x);
}

}  // namespace tautline_mutants

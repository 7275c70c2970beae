#pragma once
/// @file
/// Declares blocks of keys bound to the members of an options struct. Types and defaults are taken from the
/// struct.

#include <array>
#include <concepts>
#include <deck/keyword.hpp>
#include <deck/reader.hpp>
#include <deck/scalars.hpp>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tautline/core/types.hpp>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace tautline::deck {

template <class T>
struct Unwrapped {
  using type = T;
};
template <class T>
struct Unwrapped<std::optional<T>> {
  using type = T;
};

/// The type of a key and how a member of type T is read from a node.
template <class T>
struct Binding;

template <>
struct Binding<double> {
  static constexpr Type type = Type::number;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.number(keyword, node);
  }
  static std::string text(double value) {
    return value == value && value - value == 0 ? format_number(value) : "";
  }
};
template <>
struct Binding<int> {
  static constexpr Type type = Type::integer;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.integer(keyword, node);
  }
  static std::string text(int value) { return std::to_string(value); }
};
template <>
struct Binding<bool> {
  static constexpr Type type = Type::boolean;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.boolean(keyword, node);
  }
  static std::string text(bool value) { return value ? "true" : "false"; }
};
template <>
struct Binding<std::string> {
  static constexpr Type type = Type::text;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.text(keyword, node);
  }
  static std::string text(const std::string& value) { return value; }
};
template <>
struct Binding<std::vector<std::string>> {
  static constexpr Type type = Type::names;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.names(keyword, node);
  }
  static std::string text(const std::vector<std::string>&) { return {}; }
};
template <>
struct Binding<Vec3> {
  static constexpr Type type = Type::vector;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.vector(keyword, node);
  }
  static std::string text(const Vec3&) { return {}; }
};

template <>
struct Binding<std::array<double, 2>> {
  static constexpr Type type = Type::pair;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.pair(keyword, node);
  }
  static std::string text(const std::array<double, 2>&) { return {}; }
};

template <>
struct Binding<std::vector<double>> {
  static constexpr Type type = Type::numbers;
  static auto read(Reader& reader, const Keyword& keyword, const Node& node) {
    return reader.numbers(keyword, node);
  }
  static std::string text(const std::vector<double>&) { return {}; }
};

/// The part of the owner that holds the options: the owner itself, an alternative of a variant, or of its
/// `options`.
template <class Options, class Owner>
Options& part_of(Owner& owner) {
  if constexpr (std::same_as<Options, Owner>)
    return owner;
  else if constexpr (requires { owner.options; })
    return std::get<Options>(owner.options);
  else
    return std::get<Options>(owner);
}

template <class Owner, class Options = Owner>
class BlockBuilder {
 public:
  BlockBuilder(std::string path, std::string kind, std::string sentence) {
    block_.path = std::move(path);
    block_.kind = std::move(kind);
    block_.sentence = std::move(sentence);
    block_.begin = [](void* owner) { begin(*static_cast<Owner*>(owner)); };
    if constexpr (requires(Owner & owner) { owner.where; })
      block_.place = [](void* owner, const SourceLocation& where) {
        static_cast<Owner*>(owner)->where = where;
      };
  }

  /// A key with one value. `access` is a member pointer or a function returning a reference, of the options
  /// or the owner.
  template <class Access>
  Keyword& key(std::string name, Access access) {
    using Member = std::remove_cvref_t<decltype(reach(access, std::declval<Owner&>()))>;
    using Value = typename Unwrapped<Member>::type;
    Keyword& keyword = add(std::move(name), Binding<Value>::type);
    Owner defaults{};
    begin(defaults);
    if constexpr (std::same_as<Member, Value>)
      keyword.fallback = Binding<Value>::text(reach(access, defaults));
    keyword.read = [access](Reader& reader, const Keyword& self, Node& node, void* owner) {
      if (auto value = Binding<Value>::read(reader, self, node))
        reach(access, *static_cast<Owner*>(owner)) = *value;
    };
    return keyword;
  }

  /// A key whose value is one of a few words.
  template <class Access, class Enum>
  Keyword& choice(std::string name, Access access, std::vector<std::pair<std::string, Enum>> words) {
    Keyword& keyword = add(std::move(name), Type::choice);
    Owner defaults{};
    begin(defaults);
    for (const auto& [word, value] : words) {
      keyword.choices.push_back(word);
      if (reach(access, defaults) == value) keyword.fallback = word;
    }
    keyword.read = [access, words](Reader& reader, const Keyword& self, Node& node, void* owner) {
      const auto chosen = reader.choice(self, node);
      for (const auto& [word, value] : words)
        if (chosen == word) reach(access, *static_cast<Owner*>(owner)) = value;
    };
    return keyword;
  }

  /// A key read by a function (Reader&, const Keyword&, const Node&, Options&).
  template <class Function>
  Keyword& custom(std::string name, Type type, Function function) {
    Keyword& keyword = add(std::move(name), type);
    keyword.read = [function](Reader& reader, const Keyword& self, Node& node, void* owner) {
      function(reader, self, node, part_of<Options>(*static_cast<Owner*>(owner)));
    };
    return keyword;
  }

  /// A key that opens one block, into a member T or optional<T>.
  template <class Access>
  Keyword& block(std::string name, Access access, const BlockSet& set) {
    Keyword& keyword = add_blocks(std::move(name), Shape::single, set);
    keyword.read = [access](Reader& reader, const Keyword& self, Node& node, void* owner) {
      auto& member = reach(access, *static_cast<Owner*>(owner));
      const Reader::Step step(reader, self.name);
      if constexpr (requires { member.emplace(); })
        reader.read_block(*self.blocks, node, &member.emplace());
      else
        reader.read_block(*self.blocks, node, &member);
    };
    return keyword;
  }

  /// A key that opens a list of blocks, into a vector.
  template <class Access>
  Keyword& list(std::string name, Access access, const BlockSet& set) {
    Keyword& keyword = add_blocks(std::move(name), Shape::list, set);
    keyword.read = [access](Reader& reader, const Keyword& self, Node& node, void* owner) {
      if (!reader.expect(Node::Kind::sequence, self, node)) return;
      auto& member = reach(access, *static_cast<Owner*>(owner));
      member.resize(node.items.size());
      const Reader::Step outer(reader, self.name);
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        const Reader::Step inner(reader, std::to_string(i), label_of(node.items[i]));
        reader.read_block(*self.blocks, node.items[i], &member[i]);
      }
    };
    return keyword;
  }

  /// A key that opens blocks with names the user gives, into a map.
  template <class Access>
  Keyword& map(std::string name, Access access, const BlockSet& set) {
    Keyword& keyword = add_blocks(std::move(name), Shape::map, set);
    keyword.read = [access](Reader& reader, const Keyword& self, Node& node, void* owner) {
      if (!reader.expect(Node::Kind::mapping, self, node)) return;
      auto& member = reach(access, *static_cast<Owner*>(owner));
      const Reader::Step outer(reader, self.name);
      reader.check_duplicates(node);
      for (auto& entry : node.entries) {
        const Reader::Step inner(reader, entry.key);
        reader.read_block(*self.blocks, entry.value, &member[entry.key]);
      }
    };
    return keyword;
  }

  /// What concerns several keys: function (Reader&, const Node&, Options&).
  template <class Function>
  void check(Function function) {
    block_.check = [function](Reader& reader, const Node& node, void* owner) {
      function(reader, node, part_of<Options>(*static_cast<Owner*>(owner)));
    };
  }

  Block take() { return std::move(block_); }

 private:
  static void begin(Owner& owner) {
    if constexpr (std::same_as<Owner, Options>)
      owner = Owner{};
    else if constexpr (requires { owner.options; })
      owner.options = Options{};
    else
      owner = Options{};
  }

  template <class Access>
  static auto& reach(const Access& access, Owner& owner) {
    if constexpr (std::is_invocable_v<Access, Options&>)
      return std::invoke(access, part_of<Options>(owner));
    else
      return std::invoke(access, owner);
  }

  Keyword& add(std::string name, Type type) {
    Keyword& keyword = block_.keywords.emplace_back();
    keyword.name = std::move(name);
    keyword.type = type;
    return keyword;
  }

  Keyword& add_blocks(std::string name, Shape shape, const BlockSet& set) {
    Keyword& keyword = add(std::move(name), Type::blocks);
    keyword.shape = shape;
    keyword.blocks = &set;
    return keyword;
  }

  Block block_;
};

}  // namespace tautline::deck

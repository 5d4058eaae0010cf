// shader_options.h: the parameters that an ORTShader node sets, in its options ("3f reflectance .9
// .9 .9", one or several in a string) or in fields that it declares. Pure, any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "xvrml/node.h"

namespace xvrml::mapper {

struct ShaderOption {
  enum class Type {
    integer,
    floats,
    boolean,
    color,
    text,
    texture,
    list,
    file,
    node
  } type = Type::floats;
  std::string name;
  std::vector<float> numbers; // for 1f 2f 3f 4f 16f color floats; 1i and bool use `integer`
  int integer = 0;
  std::string text;   // for string, texture, file
  MFString otherUrls; // for texture, file: tried in turn where `text` does not lead to one
  NodeRef picture;    // for node: a texture
  const FieldInfo* field = nullptr; // not null: the node declares it
};

// More than any shader has parameters. An option takes twenty times the memory of its text.
inline constexpr size_t maximumShaderOptions = 10'000;

// Returns the valid options in order; `errors` receives one sentence per invalid option.
// Types: 1i 1f 2f 3f 4f 16f bool color string texture file floats.
// A string or URL ends at the next blank or comma, or is enclosed in 'single quotes'. It is an
// error if the rest of a word follows the comma. A list of floats ends at the first word that is
// not a number.
std::vector<ShaderOption> parseShaderOptions(const MFString& options,
                                             std::vector<std::string>& errors);

} // namespace xvrml::mapper

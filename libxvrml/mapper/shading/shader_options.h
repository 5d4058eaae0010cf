// shader_options.h: parses the options of an ORTShader node: "3f reflectance .9 .9 .9", one or
// several in a string. Pure, any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "xvrml/types.h"

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
    file
  } type = Type::floats;
  std::string name;
  std::vector<float> numbers; // for 1f 2f 3f 4f 16f color floats; 1i and bool use `integer`
  int integer = 0;
  std::string text; // for string, texture, file
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

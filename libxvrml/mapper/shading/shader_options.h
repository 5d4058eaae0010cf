// shader_options.h: the options of an ORTShader node: "3f reflectance .9 .9 .9", one or several in
// a string. Pure, any thread.
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
  std::vector<float> numbers; // 1f 2f 3f 4f 16f color floats; 1i and bool: integer below
  int integer = 0;
  std::string text; // string, texture, file
};

// More options than any shader has parameters; an option takes twenty times the memory of its text.
inline constexpr size_t maximumShaderOptions = 10'000;

// What could be read, in order; what could not, in errors, one sentence each. Types: 1i 1f 2f 3f 4f
// 16f bool color string texture file floats. A string or a URL runs to the next blank, or stands in
// 'single quotes'; a list of floats goes on as long as numbers follow.
std::vector<ShaderOption> parseShaderOptions(const MFString& options,
                                             std::vector<std::string>& errors);

} // namespace xvrml::mapper

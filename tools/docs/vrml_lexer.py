# vrml_lexer.py: highlights VRML97 worlds and .node files on the site (Pygments).
from pygments.lexer import RegexLexer, words
from pygments.token import Comment, Keyword, Name, Number, Operator, Punctuation, String, Whitespace

ACCESS = ("field", "exposedField", "eventIn", "eventOut")
TYPES = tuple(k + t
              for k in ("SF", "MF")
              for t in ("Bool", "Color", "ColorRGBA", "Double", "Float", "Image", "Int32", "Matrix3d",
                        "Matrix3f", "Matrix4d", "Matrix4f", "Node", "Rotation", "String", "Time",
                        "Vec2d", "Vec2f", "Vec3d", "Vec3f", "Vec4d", "Vec4f"))


class VrmlLexer(RegexLexer):
    name = "VRML97"
    aliases = ["vrml"]
    filenames = ["*.wrl"]
    tokens = {
        "root": [
            (r"\A#VRML.*", Comment.Special),
            (r"#.*", Comment.Single),
            (r"[\s,]+", Whitespace),
            (r'"(?:\\.|[^"\\])*"', String.Double),
            (words(("DEF", "USE", "PROTO", "EXTERNPROTO", "ROUTE", "TO", "IS"),
                   suffix=r"\b"), Keyword.Reserved),
            (words(("TRUE", "FALSE", "NULL"), suffix=r"\b"), Keyword.Constant),
            (words(ACCESS, suffix=r"\b"), Keyword.Declaration),
            (words(TYPES, suffix=r"\b"), Keyword.Type),
            (r"[+-]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)", Number),
            (r"[A-Za-z_]\w*(?=\s*\{)", Name.Class),
            (r"[^\s\"#',.\[\]\\{}\d+-][^\s\"#',.\[\]\\{}]*", Name),
            (r"[{}\[\]]", Punctuation),
            (r".", Operator),
        ]
    }


class NodeLexer(RegexLexer):
    name = "XVRML node specification"
    aliases = ["node"]
    filenames = ["*.node"]
    tokens = {
        "root": [
            (words(("component", "abstract", "clause", "change", "accepts"),
                   suffix=r"\b"), Keyword.Reserved),
            *VrmlLexer.tokens["root"],
        ]
    }

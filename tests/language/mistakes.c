/* SPDX-License-Identifier: Apache-2.0 */
/* Texts with mistakes and what is said about them: each mistake where it is, and none that follows from another. */
#include "help.h"

#define BYTES(text) text, sizeof text - 1
#define TOP "camera, film, render, study, material, light, texture, group, transform, plane, sphere, quad, disk, box, triangle, mesh, let or include"

/* Messages without their excerpts (tests/base/diag.c has those) and without the file's name. */
static const struct {
    const char *what, *text;
    size_t length;
    const char *messages;
} cases[] = {
    { "no version", BYTES("film { }\n"
      ""),
      "1:1: error: expected 'mcrender 1', the format's version, at the start, found 'film'\n"
      "" },
    { "an empty text", BYTES(""),
      "1:1: error: expected 'mcrender 1', the format's version, at the start, found end of text\n"
      "" },
    { "another version", BYTES("mcrender 2\n"
      "film { x }\n"
      ""),
      "1:10: error: format version 2 is not known, this program reads version 1\n"
      "" },
    { "a version that is no number", BYTES("mcrender film { }\n"
      ""),
      "1:10: error: expected 1, the format's version, after 'mcrender', found 'film'\n"
      "" },
    { "a misspelt first word", BYTES("mcrendr 1\n"
      "film { }\n"
      ""),
      "1:1: error: expected 'mcrender 1', the format's version, at the start, found 'mcrendr'\n"
      "1:1: note: did you mean 'mcrender'?\n"
      "" },
    { "the version twice", BYTES("mcrender 1\n"
      "mcrender 1\n"
      "film { }\n"
      ""),
      "2:1: error: 'mcrender 1' stands at the start of a text only\n"
      "" },
    { "an unknown word", BYTES("mcrender 1\n"
      "foo 3\n"
      "film { }\n"
      ""),
      "2:1: error: unknown word 'foo' at the top level, expected " TOP "\n"
      "" },
    { "a misspelt block is read as what was meant", BYTES("mcrender 1\n"
      "spere { radius 1/0 }\n"
      ""),
      "2:1: error: unknown word 'spere' at the top level, expected " TOP "\n"
      "2:1: note: did you mean 'sphere'?\n"
      "2:16: error: division by zero\n"
      "" },
    { "an unknown block is read but not judged", BYTES("mcrender 1\n"
      "foo bar { let a = 3 x 1 y { z } }\n"
      "box { x a }\n"
      ""),
      "2:1: error: unknown word 'foo' at the top level, expected " TOP "\n"
      "" },
    { "an unknown block in a block", BYTES("mcrender 1\n"
      "sphere { foo { x 1 } trasform { } radius 1 }\n"
      ""),
      "2:10: error: unknown block 'foo' in 'sphere', expected transform\n"
      "2:22: error: unknown block 'trasform' in 'sphere', expected transform\n"
      "2:22: note: did you mean 'transform'?\n"
      "" },
    { "a block in the wrong place", BYTES("mcrender 1\n"
      "sphere {\n"
      "  radius 1\n"
      "  plane { }\n"
      "  material x lambert { }\n"
      "}\n"
      ""),
      "4:3: error: 'plane' cannot stand in 'sphere'\n"
      "5:3: error: 'material' cannot stand in 'sphere'\n"
      "" },
    { "a missing }", BYTES("mcrender 1\n"
      "sphere { radius 1\n"
      "  material white\n"
      "plane { }\n"
      "film { }\n"
      ""),
      "2:8: error: the '{' of 'sphere' is not closed\n"
      "4:1: note: 'plane' cannot stand in it\n"
      "" },
    { "a missing } before a block with name and kind", BYTES("mcrender 1\n"
      "sphere { radius 1\n"
      "material white lambert { albedo 1 }\n"
      "film { }\n"
      ""),
      "2:8: error: the '{' of 'sphere' is not closed\n"
      "3:1: note: 'material' cannot stand in it\n"
      "" },
    { "a missing } of a group before the camera", BYTES("mcrender 1\n"
      "group {\n"
      "  sphere { radius 1 }\n"
      "camera perspective { }\n"
      ""),
      "2:7: error: the '{' of 'group' is not closed\n"
      "4:1: note: 'camera' cannot stand in it\n"
      "" },
    { "a missing } at the end", BYTES("mcrender 1\n"
      "group { sphere { radius 1 }\n"
      ""),
      "2:7: error: the '{' of 'group' is not closed\n"
      "" },
    { "two missing }", BYTES("mcrender 1\n"
      "group { sphere { radius 1\n"
      ""),
      "2:16: error: the '{' of 'sphere' is not closed\n"
      "2:7: error: the '{' of 'group' is not closed\n"
      "" },
    { "a } too many", BYTES("mcrender 1\n"
      "sphere { radius 1 } }\n"
      "film { }\n"
      ""),
      "2:21: error: unexpected '}', no '{' is open here\n"
      "" },
    { "a } too early", BYTES("mcrender 1\n"
      "sphere {\n"
      "  radius 1 }\n"
      "  center 2\n"
      "}\n"
      "film { }\n"
      ""),
      "4:3: error: unknown word 'center' at the top level, expected " TOP "\n"
      "4:3: note: did you mean 'render'?\n"
      "" },
    { "a missing {", BYTES("mcrender 1\n"
      "material white lambert\n"
      "  albedo 0.5\n"
      "}\n"
      "film { }\n"
      ""),
      "3:3: error: expected '{' after 'material white lambert', found 'albedo'\n"
      "" },
    { "no brackets at all", BYTES("mcrender 1\n"
      "material white lambert albedo 0.5\n"
      "film { }\n"
      ""),
      "2:24: error: expected '{' after 'material white lambert', found 'albedo'\n"
      "" },
    { "missing parts", BYTES("mcrender 1\n"
      "camera { fov 3 }\n"
      "material white { }\n"
      "material { }\n"
      ""),
      "2:8: error: expected 'camera KIND {', the kind is missing\n"
      "3:16: error: expected 'material NAME KIND {', the kind is missing\n"
      "4:10: error: expected 'material NAME KIND {', name and kind are missing\n"
      "" },
    { "parts too many", BYTES("mcrender 1\n"
      "sphere foo { }\n"
      "film x y { }\n"
      "camera a b { }\n"
      ""),
      "2:8: error: unexpected 'foo', expected '{': 'sphere' takes neither name nor kind\n"
      "3:6: error: unexpected 'x', expected '{': 'film' takes neither name nor kind\n"
      "4:10: error: unexpected 'b', expected '{': 'camera' takes a kind and no name\n"
      "" },
    { "a quoted name", BYTES("mcrender 1\n"
      "material \"white\" lambert { }\n"
      ""),
      "2:10: error: unexpected string, a name is written without quotes\n"
      "" },
    { "a missing )", BYTES("mcrender 1\n"
      "camera perspective { from (1, 2, 3   to (4, 5, 6) fov 40 }\n"
      ""),
      "2:27: error: '(' is not closed\n"
      "2:38: note: expected ',' or ')' before 'to'\n"
      "" },
    { "a missing ) before }", BYTES("mcrender 1\n"
      "film { size (1, 2 }\n"
      ""),
      "2:13: error: '(' is not closed\n"
      "2:19: note: expected ',' or ')' before '}'\n"
      "" },
    { "a missing ) of a call", BYTES("mcrender 1\n"
      "render { sampler mixture(cosine 1, light 1\n"
      "  spp 3 }\n"
      ""),
      "2:25: error: '(' is not closed\n"
      "3:3: note: expected ',' or ')' before 'spp'\n"
      "" },
    { "a missing ) before let", BYTES("mcrender 1\n"
      "let a = (1, 2\n"
      "let b = 3\n"
      "box { x a y b }\n"
      ""),
      "2:9: error: '(' is not closed\n"
      "3:1: note: expected ',' or ')' before 'let'\n"
      "" },
    { "a missing ) at the end", BYTES("mcrender 1\n"
      "box { x (1, (2,"),
      "2:13: error: '(' is not closed\n"
      "2:16: note: expected a value before end of text\n"
      "2:9: error: '(' is not closed\n"
      "2:16: note: expected ',' or ')' before end of text\n"
      "2:5: error: the '{' of 'box' is not closed\n"
      "" },
    { "missing commas", BYTES("mcrender 1\n"
      "box { x (1 2 3) y f(a 1 b 2) z max(1 2) }\n"
      ""),
      "2:12: error: expected ',' or ')', found number 2\n"
      "2:14: error: expected ',' or ')', found number 3\n"
      "2:25: error: expected ',' or ')', found 'b'\n"
      "2:38: error: expected ',' or ')', found number 2\n"
      "" },
    { "commas too many", BYTES("mcrender 1\n"
      "box { x (1,) y (,) z (1,,2) w f(a,) }\n"
      ""),
      "2:11: error: expected a value after ',', found ')'\n"
      "2:17: error: expected a value, found ','\n"
      "2:25: error: expected a value, found ','\n"
      "2:34: error: expected a value after ',', found ')'\n"
      "" },
    { "brackets with nothing in them", BYTES("mcrender 1\n"
      "box { x () y 1 }\n"
      ""),
      "2:9: error: brackets with nothing in them, expected a value\n"
      "" },
    { "square brackets", BYTES("mcrender 1\n"
      "box { x [1, 2] y ] z 1 }\n"
      ""),
      "2:9: error: unexpected character '[', tuples are written ( a, b, ... )\n"
      "2:18: error: unexpected character ']', tuples are written ( a, b, ... )\n"
      "" },
    { "two values", BYTES("mcrender 1\n"
      "box { from 1 2 3 to 4 }\n"
      ""),
      "2:14: error: unexpected number 2, expected a setting\n"
      "2:7: note: a setting takes one value, several go into a tuple: from ( a, b, ... )\n"
      "" },
    { "values with commas", BYTES("mcrender 1\n"
      "box { from 1, 2, 3 to 4, y 5 }\n"
      ""),
      "2:13: error: unexpected ',', expected a setting\n"
      "2:7: note: a setting takes one value, several go into a tuple: from ( a, b, ... )\n"
      "2:24: error: unexpected ',', expected a setting\n"
      "" },
    { "no value", BYTES("mcrender 1\n"
      "box { radius }\n"
      ""),
      "2:14: error: expected a value for 'radius', found '}'\n"
      "" },
    { "no value before a block", BYTES("mcrender 1\n"
      "box { radius transform { } y 1 }\n"
      ""),
      "2:14: error: expected a value for 'radius', found 'transform'\n"
      "" },
    { "no value before another setting", BYTES("mcrender 1\n"
      "sphere { radius\n"
      " material white }\n"
      ""),
      "3:17: error: expected a value for 'white', found '}'\n"
      "2:10: note: 'material' was read as the value of 'radius'\n"
      "" },
    { "an equals sign", BYTES("mcrender 1\n"
      "box { radius = 3 }\n"
      ""),
      "2:14: error: unexpected '=', a setting is written: radius value\n"
      "" },
    { "a colon, a semicolon", BYTES("mcrender 1\n"
      "box { radius: 3; y 4 }\n"
      ""),
      "2:13: error: unexpected character ':'\n"
      "2:16: error: unexpected character ';'\n"
      "" },
    { "operators with nothing beside them", BYTES("mcrender 1\n"
      "box { a 1 + b * 2 c 3 ^ }\n"
      "box { a 1\n"
      " + \n"
      " b 2 }\n"
      ""),
      "2:13: error: unknown name 'b'\n"
      "2:25: error: expected a value, found '}'\n"
      "5:2: error: unknown name 'b'\n"
      "" },
    { "no numbers in arithmetic", BYTES("mcrender 1\n"
      "box { a -(1, 2) b \"x\" + 1 c 2 * foo d 2 * foo(x) e f(x) + 1 }\n"
      ""),
      "2:10: error: expected a number, got a tuple\n"
      "2:19: error: expected a number, got a string\n"
      "2:33: error: unknown name 'foo'\n"
      "2:43: error: unknown function 'foo'\n"
      "2:52: error: unknown function 'f'\n"
      "" },
    { "tuples in arithmetic", BYTES("mcrender 1\n"
      "let l = (1, 2, 3)\n"
      "box { a (1, 2) * 2 b 2 / l c l * l d l + 1 e l / 0 f (1e308, 1, 1) * 10 g (1, 2, 3, 4) * 2 h -l i (\"x\", 1, 2) * 2 j l * \"x\" k l ^ 2 }\n"
      ""),
      "3:9: error: expected a number, got a tuple\n"
      "3:26: error: expected a number, got a tuple\n"
      "3:30: error: expected a number, got a tuple\n"
      "3:34: error: expected a number, got a tuple\n"
      "3:38: error: expected a number, got a tuple\n"
      "3:46: error: division by zero\n"
      "3:54: error: the result is too large, the limit is 1.797e308\n"
      "3:75: error: expected a number, got a tuple\n"
      "3:95: error: expected a number, got a tuple\n"
      "3:99: error: expected a number, got a tuple\n"
      "3:117: error: expected a number, got a tuple\n"
      "3:121: error: expected a number, got a string\n"
      "3:127: error: expected a number, got a tuple\n"
      "" },
    { "black bodies", BYTES("mcrender 1\n"
      "box { a blackbody(499) b blackbody(1000001) c blackbody() d blackbody(\"6500\") e blackbody(2000, 1) f blakbody(2000) g blackbody h blackbody(-1) }\n"
      ""),
      "2:19: error: 499 is out of range for 'blackbody', expected at least 500 and at most 1000000 kelvin\n"
      "2:36: error: 1000001 is out of range for 'blackbody', expected at least 500 and at most 1000000 kelvin\n"
      "2:47: error: 'blackbody' takes 1 argument, got 0\n"
      "2:71: error: expected a number, got a string\n"
      "2:81: error: 'blackbody' takes 1 argument, got 2\n"
      "2:102: error: unknown function 'blakbody'\n"
      "2:102: note: did you mean 'blackbody'?\n"
      "2:119: error: 'blackbody' is a function, expected '(' after it\n"
      "2:141: error: -1 is out of range for 'blackbody', expected at least 500 and at most 1000000 kelvin\n"
      "" },
    { "unknown names", BYTES("mcrender 1\n"
      "let room = 1\n"
      "box { a room b (romo, 1) c 2*sqr(3) d (white, 2) e sqr(4) f sqroot(4) }\n"
      ""),
      "3:17: error: unknown name 'romo'\n"
      "3:17: note: did you mean 'room'?\n"
      "3:30: error: unknown function 'sqr'\n"
      "3:30: note: did you mean 'sqrt'?\n"
      "3:40: error: unknown name 'white'\n"
      "3:52: error: unknown function 'sqr'\n"
      "3:52: note: did you mean 'sqrt'?\n"
      "3:61: error: unknown function 'sqroot'\n"
      "3:61: note: did you mean 'sqrt'?\n"
      "" },
    { "results that are not finite", BYTES("mcrender 1\n"
      "box { a 1/0 b 0^-1 c (-8)^0.5 d 1e300*1e300 e tan(90) f 1e308+1e308 g sqrt(-1) h 10^309 i -1e308-1e308 }\n"
      ""),
      "2:9: error: division by zero\n"
      "2:15: error: zero to a negative power\n"
      "2:22: error: a negative number to a power that is not whole\n"
      "2:33: error: the result is too large, the limit is 1.797e308\n"
      "2:47: error: the tangent is infinite here\n"
      "2:57: error: the result is too large, the limit is 1.797e308\n"
      "2:71: error: the square root of a negative number\n"
      "2:82: error: the result is too large, the limit is 1.797e308\n"
      "2:91: error: the result is too large, the limit is 1.797e308\n"
      "" },
    { "literals", BYTES("mcrender 1\n"
      "box { a 1e999 b 1e-999 c 0x10 d 1.2.3 e 12ab f nan g -inf h (infinity, 1) i 1e+ j 0e999 k 3.e l 1__ }\n"
      ""),
      "2:9: error: the number 1e999 is too large, the limit is 1.797e308\n"
      "2:17: error: the number 1e-999 is too small, it would become 0\n"
      "2:26: error: '0x10' is not a number\n"
      "2:33: error: '1.2.3' is not a number\n"
      "2:41: error: '12ab' is not a number\n"
      "2:48: error: 'nan' is no value, numbers are finite\n"
      "2:55: error: 'inf' is no value, numbers are finite\n"
      "2:62: error: 'infinity' is no value, numbers are finite\n"
      "2:77: error: '1e+' is not a number\n"
      "2:91: error: '3.e' is not a number\n"
      "2:97: error: '1__' is not a number\n"
      "" },
    { "functions", BYTES("mcrender 1\n"
      "box { a sqrt() b sqrt(1, 2) c min(1) d sqrt 2 e sqrt f pi (3) g sqrt((1, 2)) h max(1, \"a\") }\n"
      ""),
      "2:9: error: 'sqrt' takes 1 argument, got 0\n"
      "2:18: error: 'sqrt' takes 1 argument, got 2\n"
      "2:31: error: 'min' takes 2 arguments or more, got 1\n"
      "2:40: error: 'sqrt' is a function, expected '(' after it\n"
      "2:49: error: 'sqrt' is a function, expected '(' after it\n"
      "2:56: error: 'pi' is a number, expected no '(' after it\n"
      "2:70: error: expected a number, got a tuple\n"
      "2:87: error: expected a number, got a string\n"
      "" },
    { "colours", BYTES("mcrender 1\n"
      "box { a srgb(2, 0, -1) b srgb(1, 1) c hex(3) d hex(\"12345\") e hex(\"#ggg\") f hex(fff) g hex(\"\") h hex(\"##fff\") }\n"
      ""),
      "2:14: error: 2 is out of range for 'srgb', expected at least 0 and at most 1\n"
      "2:20: error: -1 is out of range for 'srgb', expected at least 0 and at most 1\n"
      "2:26: error: 'srgb' takes 3 arguments, got 2\n"
      "2:43: error: 'hex' expects a string, as hex(\"#ff8000\")\n"
      "2:52: error: expected a colour of 3 or 6 hexadecimal digits, as \"#ff8000\"\n"
      "2:67: error: expected a colour of 3 or 6 hexadecimal digits, as \"#ff8000\"\n"
      "2:81: error: unknown name 'fff'\n"
      "2:92: error: expected a colour of 3 or 6 hexadecimal digits, as \"#ff8000\"\n"
      "2:102: error: expected a colour of 3 or 6 hexadecimal digits, as \"#ff8000\"\n"
      "" },
    { "calls", BYTES("mcrender 1\n"
      "box { a f(1) b f(n=) c f(\"x\") d f(n=1 2) e f(pi) f f(g \"x\") g f(h (1)) }\n"
      ""),
      "2:11: error: expected 'name=value' or a child, found number 1\n"
      "2:20: error: expected a value, found ')'\n"
      "2:26: error: expected 'name=value' or a child, found string\n"
      "2:39: error: expected ',' or ')', found number 2\n"
      "2:46: error: expected 'name=value' or a child, found 'pi'\n"
      "2:56: error: expected a number, got a string\n"
      "2:68: error: expected 'name=value' or a child, found number 1\n"
      "" },
    { "lets", BYTES("mcrender 1\n"
      "let a 3\n"
      "let b\n"
      "let = 4\n"
      "let \"x\" = 3\n"
      "let sqrt = 1\n"
      "let pi = 1\n"
      "let c = foo\n"
      "let d = f(x)\n"
      "let e = \n"
      "let a = 4\n"
      "box { a a b b c c d d e e }\n"
      ""),
      "2:7: error: expected '=' after 'let a', found number 3\n"
      "4:1: error: expected '=' after 'let b', found 'let'\n"
      "4:5: error: expected a name after 'let', found '='\n"
      "5:5: error: expected a name after 'let', found string\n"
      "6:5: error: 'sqrt' has a meaning of its own and cannot be defined\n"
      "7:5: error: 'pi' has a meaning of its own and cannot be defined\n"
      "8:9: error: unknown name 'foo'\n"
      "9:9: error: unknown function 'f'\n"
      "11:1: error: expected a value for 'e', found 'let'\n"
      "11:5: error: 'a' is defined already\n"
      "2:5: note: the first definition is here\n"
      "" },
    { "a let in its own value", BYTES("mcrender 1\n"
      "let a = a + 1\n"
      "box { x a }\n"
      ""),
      "2:9: error: unknown name 'a'\n"
      "" },
    { "a let that is not used", BYTES("mcrender 1\n"
      "let a = 1\n"
      "let b = a\n"
      "let c = 2\n"
      "box { x c }\n"
      ""),
      "3:5: warning: 'b' is defined but not used\n"
      "" },
    { "a difference without blanks", BYTES("mcrender 1\n"
      "let a = 1\n"
      "let b = 2\n"
      "box { x 2 * a-b y (pi-a, 1) z a-1 }\n"
      ""),
      "4:13: error: unknown name 'a-b'\n"
      "4:13: note: 'a-b' is one word, a difference needs blanks: a - b\n"
      "4:20: error: unknown name 'pi-a'\n"
      "4:20: note: 'pi-a' is one word, a difference needs blanks: pi - a\n"
      "" },
    { "strings", BYTES("mcrender 1\n"
      "box { a \"x\\q\" b \"no end }\n"
      "box { a \"no end\n"
      " b 'x y' c \"\\\" }\n"
      ""),
      "2:11: error: unknown escape in a string, expected \\\", \\\\ or \\n"
      "\n"
      "2:17: error: the string has no end, expected '\"' on the same line\n"
      "3:9: error: the string has no end, expected '\"' on the same line\n"
      "4:4: error: unexpected '...', strings are written \"...\"\n"
      "4:12: error: the string has no end, expected '\"' on the same line\n"
      "" },
    { "characters", BYTES("mcrender 1\n"
      "box { a $ 1 b \303\251 c 2 gr\303\266\303\237e 3 d 4 } \001 ' \377\376\n"
      ""),
      "2:9: error: unexpected character '$'\n"
      "2:15: error: unexpected '\303\251', only strings and comments are more than ASCII\n"
      "2:24: error: unexpected '\303\266', only strings and comments are more than ASCII\n"
      "2:38: error: unexpected control character 0x01\n"
      "2:40: error: unexpected character '''\n"
      "2:42: error: unexpected byte 0xFF, the text is not UTF-8\n"
      "" },
    { "bytes in strings", BYTES("mcrender 1\n"
      "box { a \"\377\" b \"\001\" c \"\300\200\" d \"\355\240\200\" }\n"
      ""),
      "2:10: error: byte 0xFF in a string, the text is not UTF-8\n"
      "2:16: error: control character 0x01 in a string\n"
      "2:22: error: byte 0xC0 in a string, the text is not UTF-8\n"
      "2:29: error: byte 0xED in a string, the text is not UTF-8\n"
      "" },
    { "NUL bytes", BYTES("mcrender 1\000\000\n"
      "box { a 1\000 b \"\000\" } # \000\n"
      ""),
      "1:11: error: a NUL byte, expected text\n"
      "2:10: error: a NUL byte, expected text\n"
      "2:15: error: control character 0x00 in a string\n"
      "2:22: error: a NUL byte, expected text\n"
      "" },
    { "other comments", BYTES("mcrender 1 // one\n"
      "/* two\n"
      "three */ box { a 1 // four five\n"
      " }\n"
      ""),
      "1:12: error: '//' does not begin a comment, '#' does\n"
      "2:1: error: '/*' does not begin a comment, '#' does\n"
      "3:20: error: '//' does not begin a comment, '#' does\n"
      "" },
    { "carriage returns", BYTES("mcrender 1\015box { a 1\015 b 2 }\n"
      ""),
      "1:11: error: a carriage return without a line feed, lines end with LF or CR LF\n"
      "" },
    { "stray things at the top", BYTES("mcrender 1\n"
      "{ }\n"
      "(1, 2)\n"
      "= 3\n"
      "\"x\"\n"
      ", )\n"
      "film { }\n"
      ""),
      "2:1: error: unexpected '{', expected a block\n"
      "3:1: error: unexpected '(', expected a block\n"
      "" },
    { "includes", BYTES("mcrender 1\n"
      "include 3\n"
      "include \"\"\n"
      "include \"no/such file\"\n"
      "include\n"
      "include \"x\\q\"\n"
      "box { x foo * 2 }\n"
      ""),
      "2:9: error: expected a file name in quotes after 'include', found number 3\n"
      "3:9: error: expected the name of a file, found an empty string\n"
      "4:9: error: cannot read 'no/such file': No such file or directory\n"
      "6:1: error: expected a file name in quotes after 'include', found 'include'\n"
      "6:11: error: unknown escape in a string, expected \\\", \\\\ or \\n"
      "\n"
      "" },
    { "misspelt let and include", BYTES("mcrender 1\n"
      "lte a = 3\n"
      "incldue \"no/such file\"\n"
      "box { x a }\n"
      ""),
      "2:1: error: unknown word 'lte' at the top level, expected " TOP "\n"
      "2:1: note: did you mean 'let'?\n"
      "3:1: error: unknown word 'incldue' at the top level, expected " TOP "\n"
      "3:1: note: did you mean 'include'?\n"
      "3:9: error: cannot read 'no/such file': No such file or directory\n"
      "" },
    { "ten mistakes in one text", BYTES("mcrender 1\n"
      "let a = 1/0\n"
      "camra perspective { from (1, 2, 3 to (1, 2) fov = 3 }\n"
      "film { size 3 4 }\n"
      "material x { }\n"
      "sphere { radius romo*2 center (1, * 2) }\n"
      "box { a sqrt(-1) b \"x }\n"
      "group { plane { n (0, 1 0) }\n"
      "quad { c 1e999 }\n"
      ""),
      "2:9: error: division by zero\n"
      "3:1: error: unknown word 'camra' at the top level, expected " TOP "\n"
      "3:1: note: did you mean 'camera'?\n"
      "3:26: error: '(' is not closed\n"
      "3:35: note: expected ',' or ')' before 'to'\n"
      "3:49: error: unexpected '=', a setting is written: fov value\n"
      "4:15: error: unexpected number 4, expected a setting\n"
      "4:8: note: a setting takes one value, several go into a tuple: size ( a, b, ... )\n"
      "5:12: error: expected 'material NAME KIND {', the kind is missing\n"
      "6:17: error: unknown name 'romo'\n"
      "6:35: error: expected a value, found '*'\n"
      "7:9: error: the square root of a negative number\n"
      "7:20: error: the string has no end, expected '\"' on the same line\n"
      "8:25: error: expected ',' or ')', found number 0\n"
      "9:10: error: the number 1e999 is too large, the limit is 1.797e308\n"
      "8:7: error: the '{' of 'group' is not closed\n"
      "2:5: warning: 'a' is defined but not used\n"
      "" },
};

static void strip(char *messages)
{
    char *to = messages;
    for (char *at = messages, *end; *at; at = end) {
        end = strchr(at, '\n') + 1;
        if (*at == ' ')
            continue;
        if (strncmp(at, "a.scn:", 6) == 0)
            at += 6;
        memmove(to, at, (size_t)(end - at));
        to += end - at;
    }
    *to = '\0';
}

static void known_mistakes(void)
{
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct parsed parsed;
        parse_bytes(&parsed, cases[i].text, cases[i].length, NULL, 0);
        strip(parsed.messages);
        same(parsed.messages, cases[i].messages, cases[i].what);
        parsed_fini(&parsed);
    }
}

static void tree_is(const char *text, const char *tree, const char *what)
{
    struct parsed parsed;
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    same(parsed.tree, tree, what);
    parsed_fini(&parsed);
}

/* What of the tree is kept, so that what reads it has nothing false to say. */
static void kept(void)
{
    tree_is("mcrender 1 spere { radius 1/0 x 2 }", "{sphere{radius ERROR; x 2}}", "a misspelt block is kept as what was meant");
    tree_is("mcrender 1 foo { x 2 } box { }", "{box{}}!", "what is left out is noted");
    tree_is("mcrender 1 box { foo { x 2 } y 1 }", "{box{y 1}!}", "in its block");
    tree_is("mcrender 1 camera { fov 3 }", "{}!", "a block without its kind is left out");
    tree_is("mcrender 1 box { a (1, 1/0) b f(x 1/0) c f(n=1/0) d (1/0) }", "{box{a ERROR; b ERROR; c ERROR; d ERROR}}", "a value with a mistake in it is one as a whole");
    tree_is("mcrender 1 let a = 1/0 box { x a y a + 1 z (a, 1) }", "{box{x a=ERROR; y ERROR; z ERROR}}", "and goes on through let");
    tree_is("mcrender 1 include \"no/such file\" box { x a * 2 }", "{box{x ERROR}}!", "names may be defined in a file that is missing");
    tree_is("mcrender 2 box { }", "NULL", "another format is not read");
    tree_is("mcrender 1 let x = 1 let x = 2 box { y x }", "{box{y x=1}}", "the first definition stays");
}

static char *repeated(const char *before, const char *again, unsigned count, const char *after)
{
    size_t length = strlen(again);
    char *text = malloc(strlen(before) + length * count + strlen(after) + 1), *at = text + sprintf(text, "%s", before);
    for (unsigned i = 0; i < count; i++, at += length)
        memcpy(at, again, length);
    strcpy(at, after);
    return text;
}

/* One error of the right kind, at the right column, and none after it. */
static void too_deep(const char *before, const char *again, unsigned count, const char *after, const char *what)
{
    struct parsed parsed;
    char *text = repeated(before, again, count, after);
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    ok(mcr_diagnostics_errors(parsed.diagnostics) == 1 && strstr(parsed.messages, "nested deeper than 64 levels"), "%s", what);
    parsed_fini(&parsed);
    free(text);
}

static void fine(const char *before, const char *again, unsigned count, const char *after, const char *what)
{
    struct parsed parsed;
    char *text = repeated(before, again, count, after);
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    ok(parsed.root && !*parsed.messages, "%s", what);
    parsed_fini(&parsed);
    free(text);
}

static void limits(void)
{
    struct parsed parsed;
    char *text, *close = repeated("1", ")", 63, " }"), *far = repeated("", ")", 200000, " }"), *braces = repeated("", "}", 64, "");

    fine("mcrender 1 box { a ", "(", 63, close, "63 brackets in a block");
    free(close);
    close = repeated("1", ")", 64, " }");
    too_deep("mcrender 1 box { a ", "(", 64, close, "64 are too many");
    fine("mcrender 1 ", "group{", 64, braces, "64 blocks");
    fine("mcrender 1 box { a ", "-", 63, "1 }", "63 signs");
    too_deep("mcrender 1 box { a ", "-", 64, "1 b 2 }", "64 are too many");
    too_deep("mcrender 1 box { a 1", "^1", 64, " b 2 }", "as are powers of powers");
    too_deep("mcrender 1 box { a ", "f(", 200000, far, "200000 calls in calls");
    too_deep("mcrender 1 box { a ", "sqrt(", 200000, far, "functions");
    too_deep("mcrender 1 box { a ", "(", 200000, far, "brackets");
    too_deep("mcrender 1 box { a 1", "^-1", 200000, " }", "powers");
    fine("mcrender 1 box { a 1", "-1", 200000, " }", "a sum may be as long as it likes");
    free(close);
    free(far);
    close = repeated("", "}", 200000, " box { }");
    too_deep("mcrender 1 ", "group {", 200000, close, "blocks");
    free(close);
    free(braces);

    text = repeated("mcrender 1 let t = (1, 1) let a0 = (t, t)", " ", 1, "");
    for (int i = 1; i < 70; i++) {
        char more[60], *longer;
        snprintf(more, sizeof more, "let a%d = (a%d, t) ", i, i - 1);
        longer = repeated(text, more, 1, "");
        free(text);
        text = longer;
    }
    too_deep(text, " ", 1, "box { x a69 }", "tuples within each other by let");
    free(text);

    text = repeated("mcrender 1 ", "x", 256, " { }");
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    ok(strstr(parsed.messages, "a word of 256 bytes, at most 255 are allowed") != NULL, "long words");
    parsed_fini(&parsed);
    free(text);
    fine("mcrender 1 box { a 1", "0", 300, " }", "301 digits");
    fine("mcrender 1 box { a 0.", "1", 998, " }", "1000 bytes of a number");
    text = repeated("mcrender 1 box { a 0.", "1", 999, " }");
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    ok(strstr(parsed.messages, "a number of 1001 bytes, at most 1000 are allowed") != NULL, "and no more");
    parsed_fini(&parsed);
    free(text);
    text = repeated("mcrender 1 ", "} ", 100000, "");
    parse_bytes(&parsed, text, strlen(text), NULL, 0);
    ok(!parsed.root && mcr_diagnostics_errors(parsed.diagnostics) < 1100, "reading ends after a thousand mistakes");
    parsed_fini(&parsed);
    free(text);
}

int main(void)
{
    known_mistakes();
    kept();
    limits();
    return tap_done();
}

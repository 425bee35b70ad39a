# Turns a text file into a C++ string literal: cmake -DINPUT=x.css -DOUTPUT=x.css.inc -P embed_text.cmake
file(READ "${INPUT}" text)
# In pieces: a compiler need not take a literal of more than 65536 characters.
string(LENGTH "${text}" length)
set(pieces "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 8000 piece)
  string(APPEND pieces "R\"asset(${piece})asset\"\n")
  math(EXPR at "${at} + 8000")
endwhile()
file(WRITE "${OUTPUT}" "${pieces}")

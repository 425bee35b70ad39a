# Turns text files into a C++ source that defines them as an array of {name, text}:
# cmake -DINPUTS=a.h;b.h -DFOLDER=dir -DOUTPUT=x.inc -P EmbedText.cmake
set(source "")
foreach(name IN LISTS INPUTS)
  file(READ "${FOLDER}/${name}" text)
  string(APPEND source "{\"${name}\", R\"brdfit(${text})brdfit\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "${source}")

# cmake -DFILES=... -DOUT=FILE.cpp -P embed_text.cmake: text files as string constants, looked up by name (page_files.h).
set(text "#include \"processing/report/viewer/page_files.h\"\n\nnamespace lumitexel {\n\nconst PageFile kPageFiles[] = {\n")
foreach(path ${FILES})
  get_filename_component(name ${path} NAME)
  file(READ ${path} content)
  string(APPEND text "{\"${name}\", R\"lmtxl_page(${content})lmtxl_page\"},\n")
endforeach()
file(WRITE ${OUT} "${text}{nullptr, nullptr}};\n\n}  // namespace lumitexel\n")
